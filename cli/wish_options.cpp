#include "cli/wish_options.h"

#include <cassert>

#include <CLI/CLI.hpp>

namespace pmesh::cli {

CLI::Option_group* WishOptions::add_to(CLI::App& app) {
  CLI::Option_group* group = app.add_option_group("Level of detail", "at most one; default: all");
  add_wish(*group, "faces", "N", "the largest LOD with at most this many faces");
  add_wish(*group, "vertices", "N", "the largest LOD with at most this many vertices");
  add_wish(*group, "ratio", "RATIO",
           "at most this share of the full mesh's faces, above 0 and up to 1");
  add_wish(*group, "error", "E",
           "the first chunk's end at most this far from the original anywhere, in the mesh's units "
           "or, as in 0.1%, in percent of the bounding box's diagonal");
  add_wish(*group, "bytes", "N",
           "what the largest whole-chunk prefix of at most this many bytes holds");
  group->require_option(0, 1);
  return group;
}

void WishOptions::add_wish(CLI::Option_group& group, const std::string& key,
                           const std::string& type, const std::string& help) {
  group
      .add_option_function<std::string>(
          "--" + key, [this, key](const std::string& value) { query_ = key + "=" + value; }, help)
      ->check([key](const std::string& value) {
        const Result<LodRequest> wish = parse_wish(key + "=" + value);
        return wish.ok() ? std::string() : wish.error().message;
      })
      ->type_name(type);
}

LodRequest WishOptions::wish() const {
  const Result<LodRequest> parsed = parse_wish(query_);
  assert(parsed.ok());
  return parsed.value();
}

}  // namespace pmesh::cli
