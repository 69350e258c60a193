// A connection of the TCP protocol (docs/protocol.md, section 3): one coroutine reads frames and
// acts on them, another sends answers and the data of the want that stands. One stream can be open.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "protocol/messages.h"
#include "server/net/session.h"
#include "server/net/signal.h"

namespace pmesh {

class TcpSession final : public Session {
 public:
  TcpSession(boost::asio::ip::tcp::socket socket, const SessionLimits& limits, MeshStore& store);

 protected:
  boost::asio::awaitable<void> run() override;
  void on_drain() override;

 private:
  /// A want under way: the bytes [next, level.end) are still to be sent.
  struct Transfer {
    std::uint64_t next = 0;
    Resolution level;
    bool paused = false;
  };
  struct Stream {
    std::uint16_t id = 0;
    MeshPtr mesh;
    std::optional<Transfer> transfer;
  };

  boost::asio::awaitable<void> read_frames();
  boost::asio::awaitable<void> take_frames(ByteView bytes);
  bool is_sending() const;
  void take_frame(const Frame& frame);
  void take_hello(const Frame& frame);
  void take_open(const Frame& frame);
  void open_mesh(std::uint16_t stream, const Open& open);
  void take_want(const Frame& frame);
  void take_control(const Frame& frame);
  Stream* find_stream(std::uint16_t id);
  void end_transfer(Stream& stream, std::string reason);

  boost::asio::awaitable<bool> write_frames();
  boost::asio::awaitable<bool> send_next_answer();
  boost::asio::awaitable<bool> send_next_data();

  void enqueue(Bytes frame);
  void fail(std::uint16_t stream, FailureCode code, std::string text);
  void end_with(FailureCode code, std::string text);

  MeshStore& store_;
  FrameParser parser_{kMinFrameLimit};  // nothing that a client says is longer
  std::optional<Hello> peer_;           // set once its hello has come
  std::optional<Stream> stream_;

  std::deque<Bytes> answers_;  // to be sent before any more data
  std::size_t answer_bytes_ = 0;
  Signal work_;          // the writer waits for answers, a transfer or the end
  Signal room_;          // the reader waits for answers to have been sent
  bool ending_ = false;  // say what is queued, then close
  bool reading_ = true;  // the reader runs
  bool writing_ = true;  // the writer runs
};

}  // namespace pmesh
