// PM files over the frame protocol of a pmesh server (docs/protocol.md, sections 3 and 4): one mesh
// on one stream of one connection.
#pragma once

#include "client/connection.h"
#include "client/mesh_url.h"
#include "client/transport.h"
#include "protocol/frames.h"
#include "protocol/messages.h"

namespace pmesh {

class TcpTransport : public Transport {
 public:
  TcpTransport(TcpMesh mesh, const TransportOptions& options);
  TransportStatus open() override;
  TransportStatus read(const ReadRequest& request, const ByteSink& sink) override;

 private:
  TransportStatus greet();
  TransportStatus send(ByteView frames) { return connection_.write(frames); }
  TransportStatus next_frame();
  TransportStatus receive();
  TransportStatus expect(FrameType type);
  TransportStatus unexpected(const Frame& frame) const;
  TransportStatus take_data(const Frame& frame, const ByteSink& sink, bool& wants_more);
  TransportError broken(const std::string& why) const;

  TcpMesh mesh_;
  Connection connection_;
  FrameParser parser_;
  Bytes buffer_;
  ByteView unread_;  // of buffer_
};

}  // namespace pmesh
