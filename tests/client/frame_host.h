// Servers of the frame protocol for the client's tests, over TCP and over WebSocket: they serve the
// sample under any id, and misbehave as told.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "protocol/messages.h"
#include "tests/client/loopback.h"

namespace pmesh::test {

/// What a frame server does wrong; by default nothing.
struct FrameBehaviour {
  std::function<std::size_t()> cut_after{};  ///< If set: bytes of an answer until it is cut.
  Bytes instead_of_opened{};
  Bytes instead_of_data{};
  Bytes before_data{};
  int stalls = 0;                ///< So many wants get no answer.
  std::size_t data_bytes = 500;  ///< Of the file in a data frame.
};

/// What the servers have in common. One conversation at a time.
class FrameHost {
 public:
  explicit FrameHost(FrameBehaviour behaviour, Bytes file);

  struct Answer {
    std::vector<Bytes> frames;
    std::size_t allowed = SIZE_MAX;  ///< So many bytes of them, then a cut.
  };
  Answer answer(const Frame& frame);

  const std::vector<Want>& wants() const { return wants_; }
  const std::vector<std::string>& opened() const { return opened_; }

 private:
  Answer answer_want(const Frame& frame);

  Bytes file_;
  FrameBehaviour behaviour_;
  std::vector<Want> wants_;
  std::vector<std::string> opened_;
};

class FrameServer {
 public:
  explicit FrameServer(FrameBehaviour behaviour);
  FrameServer(FrameBehaviour behaviour, Bytes file);

  std::string url() const { return "tcp://127.0.0.1:" + std::to_string(port()) + "/mesh"; }
  std::uint16_t port() const { return server_.port(); }
  int connections() const { return server_.connections(); }
  const std::vector<Want>& wants() const { return host_.wants(); }
  /// The ids asked for, as they came, and "token ..." for every token shown.
  const std::vector<std::string>& opened() const { return host_.opened(); }

 private:
  void serve(Peer& peer);

  FrameHost host_;
  LoopbackServer server_;
};

/// Upgrades every connection, whatever its target, and speaks one frame a message.
class WebSocketServer {
 public:
  /// After an upgrade it sends `raw`, unless that is empty, and nothing else.
  explicit WebSocketServer(FrameBehaviour behaviour, std::string raw = "");

  std::string url() const { return "ws://127.0.0.1:" + std::to_string(port()) + "/mesh"; }
  std::uint16_t port() const { return server_.port(); }
  int connections() const { return server_.connections(); }
  /// The upgrades asked for: request lines and fields.
  const std::vector<std::string>& requests() const { return requests_; }
  /// Whether every message that came was one binary frame.
  bool was_one_frame_a_message() const { return was_one_frame_a_message_; }

 private:
  void serve(Peer& peer);

  FrameHost host_;
  std::string raw_;
  std::vector<std::string> requests_;
  bool was_one_frame_a_message_ = true;
  LoopbackServer server_;
};

}  // namespace pmesh::test
