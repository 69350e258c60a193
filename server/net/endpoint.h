// "ADDRESS:PORT", as settings spell where to listen.
//
// Threads: pure functions.
#pragma once

#include <string>

#include <boost/asio/ip/tcp.hpp>

#include "core/base/result.h"

namespace pmesh {

/// Reads "127.0.0.1:8080" or "[::1]:8080"; names are not looked up. Fails (usage) on anything else.
Result<boost::asio::ip::tcp::endpoint> parse_endpoint(const std::string& text);

}  // namespace pmesh
