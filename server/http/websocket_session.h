// A WebSocket that carries frames, one in each binary message (docs/protocol.md, section 3.4). The
// WebSocket itself is Beast's.
#pragma once

#include <array>
#include <optional>

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "server/frames/frame_conversation.h"
#include "server/http/channel_stream.h"
#include "server/http/request_parser.h"

namespace pmesh {

class WebSocketFrameWire final : public FrameWire {
 public:
  explicit WebSocketFrameWire(Channel& channel);

  /// Answers the request that asks for a WebSocket; false if it asks wrongly, and was told so.
  Awaitable<bool> accept(const RequestParser::Message& request);

  Executor executor() override { return channel_.executor(); }
  Awaitable<Arrival> next() override;
  const Frame& frame() override { return frame_; }
  Awaitable<void> stop_reading() override;
  Awaitable<bool> send(ByteView frame) override;
  Awaitable<bool> send_data(ByteView head, const MeshFile& mesh, ByteSpan span) override;
  Awaitable<void> close_gently() override;
  void reset() override { channel_.reset(); }

 private:
  Channel& channel_;
  boost::beast::websocket::stream<ChannelStream> stream_;
  boost::beast::flat_buffer buffer_{kFrameHeaderBytes + kMinFrameLimit};
  Frame frame_;
  Bytes message_;  // of data, while it is sent
};

/// Threads: all on the channel's thread. The channel must outlive it.
class WebSocketSession {
 public:
  WebSocketSession(Channel& channel, Services& services, PolicyPtr policy, std::string client,
                   FrameCredentials credentials)
      : wire_(channel),
        conversation_(wire_, services, std::move(policy), std::move(client),
                      std::move(credentials)) {}

  /// From the request that asks for it to the connection's end. `owner` keeps this object.
  Awaitable<void> run(const RequestParser::Message& request, std::shared_ptr<void> owner);
  void drain() { conversation_.drain(); }

 private:
  WebSocketFrameWire wire_;
  FrameConversation conversation_;
};

}  // namespace pmesh
