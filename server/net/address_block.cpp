#include "server/net/address_block.h"

#include <algorithm>
#include <array>

#include "core/base/parse_number.h"
#include "core/base/trimmed.h"

namespace pmesh {

namespace ip = boost::asio::ip;

namespace {

/// The address's bytes as one line of bits, IPv4 as IPv6 would map it.
std::array<unsigned char, 16> bits_of(const ip::address& address) {
  if (address.is_v6()) return address.to_v6().to_bytes();
  return ip::make_address_v6(ip::v4_mapped, address.to_v4()).to_bytes();
}

constexpr unsigned kMappedBits = 96;

/// Whether `a` and `b` agree in their first `count` bits.
bool share_prefix(const std::array<unsigned char, 16>& a, const std::array<unsigned char, 16>& b,
                  unsigned count) {
  const unsigned whole = count / 8;
  if (!std::equal(a.begin(), a.begin() + whole, b.begin())) return false;
  if (count % 8 == 0) return true;
  const unsigned shift = 8 - count % 8;
  return a[whole] >> shift == b[whole] >> shift;
}

}  // namespace

ip::address unmapped(const ip::address& address) {
  if (!address.is_v6() || !address.to_v6().is_v4_mapped()) return address;
  return ip::make_address_v4(ip::v4_mapped, address.to_v6());
}

Result<AddressBlock> AddressBlock::parse(std::string_view text) {
  const Error wrong{ErrorCode::usage,
                    std::string(text) + ": expected an address or a block such as 192.0.2.0/24"};
  const std::size_t slash = text.find('/');
  boost::system::error_code error;
  const ip::address network = ip::make_address(std::string(text.substr(0, slash)), error);
  if (error) return wrong;
  const unsigned widest = network.is_v4() ? 32 : 128;
  unsigned bits = widest;
  if (slash != std::string_view::npos) {
    const auto parsed = parse_whole<std::uint8_t>(text.substr(slash + 1));
    if (!parsed || *parsed > widest) return wrong;
    bits = *parsed;
  }
  const unsigned prefix = network.is_v4() ? bits + kMappedBits : bits;
  const auto all_bits = bits_of(network);
  for (unsigned i = prefix; i < 128; ++i) {
    if ((all_bits[i / 8] >> (7 - i % 8) & 1) != 0) return wrong;
  }
  return AddressBlock(network, prefix);
}

bool AddressBlock::contains(const ip::address& address) const {
  return share_prefix(bits_of(network_), bits_of(address), prefix_bits_);
}

Result<TrustedProxies> TrustedProxies::parse(const std::vector<std::string>& blocks) {
  TrustedProxies proxies;
  for (const std::string& text : blocks) {
    const auto block = AddressBlock::parse(text);
    if (!block) return block.error();
    proxies.blocks_.push_back(*block);
  }
  return proxies;
}

bool TrustedProxies::contains(const ip::address& address) const {
  return std::any_of(blocks_.begin(), blocks_.end(),
                     [&](const AddressBlock& block) { return block.contains(address); });
}

ip::address TrustedProxies::client_of(const ip::address& proxy,
                                      std::string_view forwarded_for) const {
  ip::address client = proxy;
  while (!forwarded_for.empty() && contains(client)) {
    const std::size_t comma = forwarded_for.rfind(',');
    const std::string_view last =
        comma == std::string_view::npos ? forwarded_for : forwarded_for.substr(comma + 1);
    boost::system::error_code error;
    const ip::address named = ip::make_address(std::string(trimmed(last)), error);
    if (error) break;
    client = unmapped(named);
    forwarded_for =
        comma == std::string_view::npos ? std::string_view() : forwarded_for.substr(0, comma);
  }
  return client;
}

}  // namespace pmesh
