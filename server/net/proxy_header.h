// The PROXY protocol, versions 1 and 2, by which a proxy says before all else for whom it has
// connected (https://www.haproxy.org/download/2.6/doc/proxy-protocol.txt).
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include <boost/asio/ip/address.hpp>

namespace pmesh {

/// Longer headers are bad: a version 1 line has 107 bytes at most, and of version 2 we take the
/// addresses and some room for additions.
inline constexpr std::size_t kMaxProxyHeaderBytes = 1024;

struct ProxyHeader {
  enum Kind {
    more,    ///< What there is may be the begin of a header.
    none,    ///< No header: the connection's own bytes begin at once.
    header,  ///< The first `bytes` are one.
    bad,     ///< It begins as a header and is none.
  };
  Kind kind = none;
  std::size_t bytes = 0;
  /// Nothing if the proxy speaks for itself (LOCAL, UNKNOWN), as for its health checks.
  std::optional<boost::asio::ip::address> client;
};

/// What the first bytes of a connection are. Threads: a pure function.
ProxyHeader parse_proxy_header(std::string_view bytes);

}  // namespace pmesh
