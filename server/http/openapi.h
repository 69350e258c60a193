// The description of the HTTP interface, docs/openapi.json, as /openapi.json answers it.
#pragma once

#include <string_view>

namespace pmesh {

/// The file's text, embedded when the server was built.
std::string_view openapi_json();

}  // namespace pmesh
