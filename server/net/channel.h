// A connected socket with timeouts: what HTTP and TCP sessions are written on. Files leave by
// sendfile(2), without passing through this process.
#pragma once

#include <chrono>
#include <memory>
#include <span>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "core/base/bytes.h"
#include "protocol/byte_range.h"
#include "server/net/deadline.h"
#include "server/store/mesh_file.h"
#include "server/options.h"

namespace pmesh {

/// Threads: all on the socket's executor, which is a strand. At most one receive and one send at a
/// time. After reset() or a failed send everything fails at once.
class Channel {
 public:
  Channel(boost::asio::ip::tcp::socket socket, const SessionLimits& limits);
  ~Channel();
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  const boost::asio::ip::tcp::socket::executor_type& executor() { return executor_; }

  /// Waits for bytes and gives their number; 0 if the peer closed, the connection broke, the time
  /// was up (then timed_out() is true), or interrupt_receive() was called meanwhile.
  boost::asio::awaitable<std::size_t> receive(std::span<char> into, Deadline::Clock::time_point by);
  bool timed_out() const { return timed_out_; }
  void interrupt_receive();

  /// Sends all of it; false if that failed. `more_follows` holds a last, small packet back until
  /// the next call (MSG_MORE).
  boost::asio::awaitable<bool> send(ByteView bytes, bool more_follows = false);

  /// Sends these bytes of the file; false if that failed or the file is no longer intact. Then the
  /// peer has been sent too little, and the connection must be cut.
  boost::asio::awaitable<bool> send_file(const MeshFile& mesh, ByteSpan span);

  /// Ends the connection. What was sent still arrives if the peer has not sent anything unread.
  void close();

  /// Ends the connection so that the peer gets all that was sent, even if it was still sending.
  boost::asio::awaitable<void> close_gently();

  /// Ends it at once: the peer gets a reset, the kernel drops what it had queued.
  void reset();

 private:
  boost::asio::awaitable<bool> wait_until_writable();

  boost::asio::ip::tcp::socket socket_;
  boost::asio::ip::tcp::socket::executor_type executor_;
  const std::chrono::milliseconds send_timeout_;
  std::shared_ptr<Deadline> receive_deadline_;
  std::shared_ptr<Deadline> send_deadline_;
  bool timed_out_ = false;
  bool interrupted_ = false;
};

}  // namespace pmesh
