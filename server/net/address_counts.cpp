#include "server/net/address_counts.h"

#include <algorithm>
#include <functional>
#include <string_view>

#include "server/net/address_block.h"

namespace pmesh {

namespace ip = boost::asio::ip;

namespace {

constexpr std::size_t kNetworkBytes = 8;  // of an IPv6 address

/// What an address is counted by.
ip::address key_of(const ip::address& address) {
  const ip::address plain = unmapped(address);
  if (plain.is_v4()) return plain;
  auto bytes = plain.to_v6().to_bytes();
  std::fill(bytes.begin() + kNetworkBytes, bytes.end(), static_cast<unsigned char>(0));
  return ip::address_v6(bytes);
}

}  // namespace

std::size_t AddressCounts::Hash::operator()(const ip::address& address) const {
  if (address.is_v4()) return std::hash<std::uint32_t>()(address.to_v4().to_uint());
  const auto bytes = address.to_v6().to_bytes();
  return std::hash<std::string_view>()({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::optional<AddressCounts::Slot> AddressCounts::enter(const ip::address& address) {
  const ip::address key = key_of(address);
  const std::lock_guard lock(mutex_);
  std::size_t& count = counts_[key];
  if (most_ > 0 && count >= most_) return {};
  ++count;
  return Slot(this, key);
}

void AddressCounts::leave(const ip::address& key) {
  const std::lock_guard lock(mutex_);
  const auto place = counts_.find(key);
  if (--place->second == 0) counts_.erase(place);
}

}  // namespace pmesh
