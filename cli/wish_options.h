// The five mutually exclusive options that say which level of detail is wanted: the command line's
// spelling of LodRequest, shared by `extract` and `fetch`.
#pragma once

#include <string>

#include <CLI/App.hpp>

#include "protocol/lod_request.h"

namespace pmesh::cli {

/// Must outlive the parsing of the CLI::App that it was added to.
class WishOptions {
 public:
  /// Adds --faces, --vertices, --ratio, --error and --bytes to `app`. A value that parse_wish
  /// refuses, or a second wish, is a usage error of the parser. Gives the group of the five, on
  /// which a verb may call require_option(1) to demand a wish.
  CLI::Option_group* add_to(CLI::App& app);

  /// After parsing: the wish; everything if no option was given.
  LodRequest wish() const;

 private:
  void add_wish(CLI::Option_group& group, const std::string& key, const std::string& type,
                const std::string& help);

  std::string query_;
};

}  // namespace pmesh::cli
