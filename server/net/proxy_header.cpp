#include "server/net/proxy_header.h"

#include <algorithm>
#include <array>
#include <string>

namespace pmesh {

namespace ip = boost::asio::ip;

namespace {

constexpr std::string_view kTextSignature = "PROXY ";
constexpr std::string_view kBinarySignature("\r\n\r\n\0\r\nQUIT\n", 12);
constexpr std::size_t kMaxTextBytes = 107;
constexpr std::size_t kBinaryHeadBytes = 16;

bool begins_alike(std::string_view bytes, std::string_view signature) {
  const std::size_t count = std::min(bytes.size(), signature.size());
  return bytes.substr(0, count) == signature.substr(0, count);
}

std::string_view take_word(std::string_view& line) {
  const std::size_t space = line.find(' ');
  const std::string_view word = line.substr(0, space);
  line.remove_prefix(std::min(line.size(), word.size() + 1));
  return word;
}

/// "PROXY TCP4 SOURCE DESTINATION PORT PORT\r\n", or "PROXY UNKNOWN ...\r\n".
ProxyHeader parse_text(std::string_view bytes) {
  const std::size_t end = bytes.substr(0, kMaxTextBytes).find("\r\n");
  if (end == std::string_view::npos) {
    return {bytes.size() < kMaxTextBytes ? ProxyHeader::more : ProxyHeader::bad, 0, {}};
  }
  std::string_view line = bytes.substr(kTextSignature.size(), end - kTextSignature.size());
  const std::string_view family = take_word(line);
  if (family == "UNKNOWN") return {ProxyHeader::header, end + 2, {}};
  const bool is_v4 = family == "TCP4";
  if (!is_v4 && family != "TCP6") return {ProxyHeader::bad, 0, {}};
  boost::system::error_code error;
  const ip::address client = ip::make_address(std::string(take_word(line)), error);
  if (error || client.is_v4() != is_v4) return {ProxyHeader::bad, 0, {}};
  return {ProxyHeader::header, end + 2, client};
}

template <class Address>
ip::address address_at(std::string_view bytes) {
  typename Address::bytes_type raw;
  std::transform(bytes.begin(), bytes.begin() + raw.size(), raw.begin(),
                 [](char byte) { return static_cast<unsigned char>(byte); });
  return Address(raw);
}

ProxyHeader parse_binary(std::string_view bytes) {
  if (bytes.size() < kBinaryHeadBytes) return {ProxyHeader::more, 0, {}};
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  const unsigned version = at(12) >> 4, command = at(12) & 15, family = at(13);
  const std::size_t length = kBinaryHeadBytes + at(14) * 256u + at(15);
  if (version != 2 || command > 1 || length > kMaxProxyHeaderBytes) {
    return {ProxyHeader::bad, 0, {}};
  }
  if (bytes.size() < length) return {ProxyHeader::more, 0, {}};
  constexpr unsigned kLocal = 0, kTcp4 = 0x11, kTcp6 = 0x21;
  constexpr std::size_t kTcp4Bytes = 12, kTcp6Bytes = 36;
  const std::string_view addresses = bytes.substr(kBinaryHeadBytes, length - kBinaryHeadBytes);
  ProxyHeader header{ProxyHeader::header, length, {}};
  if (command == kLocal) return header;
  if (family == kTcp4 && addresses.size() >= kTcp4Bytes) {
    header.client = address_at<ip::address_v4>(addresses);
  } else if (family == kTcp6 && addresses.size() >= kTcp6Bytes) {
    header.client = address_at<ip::address_v6>(addresses);
  } else if (family == kTcp4 || family == kTcp6) {
    header.kind = ProxyHeader::bad;
  }
  return header;
}

}  // namespace

ProxyHeader parse_proxy_header(std::string_view bytes) {
  const bool may_be_text = begins_alike(bytes, kTextSignature);
  const bool may_be_binary = begins_alike(bytes, kBinarySignature);
  if (!may_be_text && !may_be_binary) return {};
  if (may_be_text && bytes.size() >= kTextSignature.size()) return parse_text(bytes);
  if (may_be_binary && bytes.size() >= kBinarySignature.size()) return parse_binary(bytes);
  return {ProxyHeader::more, 0, {}};
}

}  // namespace pmesh
