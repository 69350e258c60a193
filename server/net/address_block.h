// Blocks of IP addresses (CIDR), for saying which peers are trusted proxies.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <boost/asio/ip/address.hpp>

#include "core/base/result.h"

namespace pmesh {

/// An IPv4 address that came in an IPv6 one (::ffff:192.0.2.1) as itself, any other as it is.
boost::asio::ip::address unmapped(const boost::asio::ip::address& address);

/// "192.0.2.0/24", "2001:db8::/32", or one address. Threads: immutable.
class AddressBlock {
 public:
  /// Fails (usage) if `text` is none, or has bits set beyond its prefix.
  static Result<AddressBlock> parse(std::string_view text);

  /// Mapped addresses count as what they hold.
  bool contains(const boost::asio::ip::address& address) const;

 private:
  AddressBlock(const boost::asio::ip::address& network, unsigned prefix_bits)
      : network_(network), prefix_bits_(prefix_bits) {}

  boost::asio::ip::address network_;
  unsigned prefix_bits_;
};

/// The proxies whose word on whom they speak for is believed.
class TrustedProxies {
 public:
  TrustedProxies() = default;
  /// Fails (usage) on what is no block.
  static Result<TrustedProxies> parse(const std::vector<std::string>& blocks);

  bool contains(const boost::asio::ip::address& address) const;

  /// The client that a trusted proxy speaks for by X-Forwarded-For: the last address of the list
  /// that is not itself a trusted proxy's. `proxy` itself if there is none, or if what stands there
  /// is no address.
  boost::asio::ip::address client_of(const boost::asio::ip::address& proxy,
                                     std::string_view forwarded_for) const;

 private:
  std::vector<AddressBlock> blocks_;
};

}  // namespace pmesh
