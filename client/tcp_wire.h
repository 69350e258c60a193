// Frames on a plain TCP connection, or on one with TLS, one after another without gaps.
#pragma once

#include "client/connection.h"
#include "client/frame_wire.h"

namespace pmesh {

class TcpWire : public FrameWire {
 public:
  TcpWire(Endpoint endpoint, const TransportOptions& options);

  std::string peer() const override { return endpoint_.text(); }
  TransportStatus connect() override { return connection_.connect(endpoint_); }
  bool is_open() const override { return connection_.is_open(); }
  void close() override { connection_.close(); }
  TransportStatus send(std::span<const Bytes> frames) override;
  TransportStatus receive(std::span<std::uint8_t> buffer, std::size_t& count) override {
    return connection_.read_some(buffer, count);
  }

 private:
  Endpoint endpoint_;
  Connection connection_;
};

}  // namespace pmesh
