// PM files by the frame protocol of a pmesh server (docs/protocol.md, sections 3 and 4), whatever
// carries the frames: one mesh on one stream of one connection.
#pragma once

#include <initializer_list>
#include <memory>
#include <string>

#include "client/frame_wire.h"
#include "client/transport.h"
#include "protocol/frames.h"
#include "protocol/messages.h"

namespace pmesh {

class FrameTransport : public Transport {
 public:
  /// `id` is the mesh's, perhaps with what lets one in (docs/protocol.md, section 2.8).
  /// A `token` is shown to the server first; it may be empty.
  FrameTransport(std::unique_ptr<FrameWire> wire, std::string id, std::string token = "");
  TransportStatus open() override;
  /// Of a frame that a lost connection has cut, what came of its data is given too.
  TransportStatus read(const ReadRequest& request, const ByteSink& sink) override;

 private:
  TransportStatus greet();
  TransportStatus converse(const ReadRequest& request, const ByteSink& sink);
  TransportStatus next_frame();
  TransportStatus receive();
  TransportStatus expect(FrameType type);
  TransportStatus unexpected(const Frame& frame) const;
  TransportStatus take_data(const Frame& frame, const ByteSink& sink, bool& wants_more);
  void take_unfinished(const ByteSink& sink);
  TransportError broken(const std::string& why) const;

  std::unique_ptr<FrameWire> wire_;
  std::string id_;
  std::string token_;
  FrameParser parser_;
  Bytes buffer_;
  ByteView unread_;  // of buffer_
};

}  // namespace pmesh
