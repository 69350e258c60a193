// Frames over a WebSocket (docs/protocol.md, section 3): each a binary message, uncompressed. To
// a peer that cuts its frames into messages otherwise it listens too.
#pragma once

#include <memory>

#include "client/frame_wire.h"
#include "client/mesh_url.h"

namespace pmesh {

class WebSocketWire : public FrameWire {
 public:
  WebSocketWire(const HttpMesh& mesh, const TransportOptions& options);
  ~WebSocketWire() override;

  std::string peer() const override;
  /// Another wire is wanted if the upgrade is answered by anything but 101, 401 and 403, or if the
  /// peer then breaks the rules of RFC 6455.
  TransportStatus connect() override;
  bool is_open() const override;
  void close() override;
  TransportStatus send(std::span<const Bytes> frames) override;
  TransportStatus receive(std::span<std::uint8_t> buffer, std::size_t& count) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pmesh
