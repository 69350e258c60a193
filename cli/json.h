// The one JSON object that a verb prints on stdout under --json.
#pragma once

#include <cstdio>

#include <nlohmann/json.hpp>

namespace pmesh::cli {

using Json = nlohmann::ordered_json;  // members in the order in which they are written

/// Bytes of names that are not UTF-8 are replaced: a file may have any name.
inline void print_json(const Json& json) {
  std::puts(json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
}

}  // namespace pmesh::cli
