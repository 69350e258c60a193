#include "server/net/endpoint.h"

#include "core/base/parse_number.h"

namespace pmesh {

namespace asio = boost::asio;

Result<asio::ip::tcp::endpoint> parse_endpoint(const std::string& text) {
  const Error wrong{ErrorCode::usage, text + ": expected ADDRESS:PORT, such as 127.0.0.1:8080"};
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return wrong;
  std::string host = text.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  const auto port = parse_whole<std::uint16_t>(std::string_view(text).substr(colon + 1));
  boost::system::error_code bad_host;
  const auto address = asio::ip::make_address(host, bad_host);
  if (bad_host || !port) return wrong;
  return asio::ip::tcp::endpoint(address, *port);
}

}  // namespace pmesh
