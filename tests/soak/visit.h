// One connection of a client that asks for what it likes, checks every byte, and sometimes leaves
// without a word.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "tests/soak/meshes.h"

namespace pmesh::soak {

/// What came of all visits. One thread.
struct Tally {
  std::uint64_t connections = 0;
  std::uint64_t answers = 0;
  std::uint64_t bytes = 0;
  std::uint64_t aborts = 0;
  std::uint64_t busy = 0;  ///< Finished levels that the server had no room to make.
  std::vector<std::string> faults;
};

/// Belongs to one client.
struct Visitor {
  const std::vector<SoakMesh>& meshes;
  std::uint16_t http_port;
  std::uint16_t tcp_port;
  boost::asio::ip::address_v4 from;
  Random random;
  Tally& tally;
  /// The bodies of finished levels by their targets, which all clients share: always the same.
  std::map<std::string, std::string>& levels;

  const SoakMesh& any_mesh() { return meshes[below(random, meshes.size())]; }
  void fault(const std::string& what) { tally.faults.push_back(what); }
};

using Socket = boost::asio::ip::tcp::socket;

/// From the visitor's address. Throws boost::system::system_error, as the visits do if the
/// connection breaks.
boost::asio::awaitable<Socket> connect(Visitor& visitor, std::uint16_t port);

/// Ends the connection as one whose process dies, or as one who has had enough.
void abort(Visitor& visitor, Socket& socket);

/// Requests of every kind, one after another or pipelined.
boost::asio::awaitable<void> visit_http(Visitor& visitor);

/// Wants over the frame protocol, with pauses, cancellations and replacements.
boost::asio::awaitable<void> visit_tcp(Visitor& visitor);
boost::asio::awaitable<void> visit_web_socket(Visitor& visitor);

}  // namespace pmesh::soak
