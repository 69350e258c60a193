// The page at `/`: what is served, and how to fetch it.
#pragma once

#include <string_view>

namespace pmesh {

/// An HTML page that lists the catalogue by its own script. The same for all requests.
std::string_view viewer_page();

}  // namespace pmesh
