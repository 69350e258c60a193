// A TCP connection that carries frames (docs/protocol.md, section 3).
#pragma once

#include <array>
#include <optional>
#include <string>

#include "server/frames/frame_conversation.h"
#include "server/net/session.h"

namespace pmesh {

/// Frames one after another on a channel; data leave by sendfile(2).
class ChannelFrameWire final : public FrameWire {
 public:
  explicit ChannelFrameWire(Channel& channel) : channel_(channel) {}

  Executor executor() override { return channel_.executor(); }
  Awaitable<Arrival> next() override;
  const Frame& frame() override { return parser_.frame(); }
  Awaitable<void> stop_reading() override;
  Awaitable<bool> send(ByteView frame) override { return channel_.send({frame}); }
  Awaitable<bool> send_data(ByteView head, const MeshFile& mesh, ByteSpan span) override {
    return channel_.send({head, &mesh, span});
  }
  Awaitable<void> close_gently() override { return channel_.close_gently(); }
  void reset() override { channel_.reset(); }

 private:
  Channel& channel_;
  FrameParser parser_{kMinFrameLimit};  // nothing that a client says is longer
  std::array<char, 1024> buffer_;
  ByteView unread_;  // of the buffer
  bool interrupted_ = false;
};

class TcpSession final : public Session {
 public:
  TcpSession(Socket socket, Services& services, AddressCounts::Slot slot)
      : Session(std::move(socket), services, WireProtocol::frames, std::move(slot)) {}

  /// What a client is told that there is no room for.
  static std::string refusal_text();

 protected:
  Awaitable<void> run() override;
  void on_drain() override;
  std::string refusal() const override { return refusal_text(); }

 private:
  ChannelFrameWire wire_{channel_};
  std::optional<FrameConversation> conversation_;
};

}  // namespace pmesh
