#include "client/tcp_wire.h"

#include <utility>

namespace pmesh {

TcpWire::TcpWire(Endpoint endpoint, const TransportOptions& options)
    : endpoint_(std::move(endpoint)), connection_(options) {}

TransportStatus TcpWire::send(std::span<const Bytes> frames) {
  Bytes together;
  for (const Bytes& frame : frames) together.insert(together.end(), frame.begin(), frame.end());
  return connection_.write(together);
}

}  // namespace pmesh
