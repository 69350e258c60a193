// What carries frames between the server and one client: a TCP connection, or a WebSocket.
#pragma once

#include "core/base/bytes.h"
#include "protocol/byte_range.h"
#include "protocol/frames.h"
#include "server/net/asio_types.h"
#include "server/store/mesh_file.h"

namespace pmesh {

/// At most one next() and one send at a time. Threads: all on the executor, which runs one handler
/// at a time.
class FrameWire {
 public:
  virtual ~FrameWire() = default;

  virtual Executor executor() = 0;

  /// What came of waiting for a frame.
  struct Arrival {
    enum Kind : std::uint8_t { frame, bad, end } kind = end;
    std::string why{};  ///< What is wrong with what came, if it is bad.
  };

  /// Waits for the next frame; then frame() is it, until the next call. `end` if the peer closed,
  /// the connection broke, or stop_reading() was called.
  virtual Awaitable<Arrival> next() = 0;
  virtual const Frame& frame() = 0;
  /// Makes next() end, now and from now on. Nothing is to be sent any more.
  virtual Awaitable<void> stop_reading() = 0;

  /// Sends a frame; false if that failed.
  virtual Awaitable<bool> send(ByteView frame) = 0;
  /// Sends a data frame: its `head`, then the file's bytes. False if that failed or the file is no
  /// longer intact; then the connection must be cut.
  virtual Awaitable<bool> send_data(ByteView head, const MeshFile& mesh, ByteSpan span) = 0;

  /// Ends the connection so that the peer gets all that was sent. Precondition: stop_reading() was
  /// called and next() has ended.
  virtual Awaitable<void> close_gently() = 0;
  /// Ends it at once.
  virtual void reset() = 0;
};

}  // namespace pmesh
