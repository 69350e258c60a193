// A connected socket with timeouts: what HTTP and frame sessions are written on. Without TLS files
// leave by sendfile(2), without passing through this process; with it, by way of one record.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <span>

#include "core/base/bytes.h"
#include "protocol/byte_range.h"
#include "server/net/asio_types.h"
#include "server/net/deadline.h"
#include "server/net/tls.h"
#include "server/options.h"
#include "server/store/mesh_file.h"

namespace pmesh {

/// Threads: all on the socket's executor, which runs one handler at a time. At most one receive and
/// one send at a time. After reset() or a failed send everything fails at once.
class Channel {
 public:
  Channel(Socket socket, const SessionLimits& limits);
  ~Channel();
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  const Executor& executor() { return executor_; }

  /// The other end's address; unspecified if the connection is over already.
  boost::asio::ip::address peer() const;

  /// Speaks TLS from now on; false if the peer does not, or not by then (then timed_out() is true).
  /// Precondition: nothing was received or sent. Throws std::bad_alloc.
  Awaitable<bool> start_tls(const TlsContext& context, Deadline::Clock::time_point by);

  /// Waits for bytes and gives their number; 0 if the peer closed, the connection broke, the time
  /// was up (then timed_out() is true), or interrupt_receive() was called meanwhile.
  Awaitable<std::size_t> receive(std::span<char> into, Deadline::Clock::time_point by);
  bool timed_out() const { return timed_out_; }
  void interrupt_receive();

  /// Waits until something can be received; false if the time was up first.
  Awaitable<bool> wait_for_bytes(Deadline::Clock::time_point by);
  /// What has arrived and was not received yet, up to the size of `into`; it stays unreceived.
  /// Empty if nothing has, or the connection is over. Precondition: no TLS.
  std::span<char> peek(std::span<char> into);

  /// Bytes, and then perhaps some of a file, on their way out.
  struct Parcel {
    ByteView head;
    const MeshFile* mesh = nullptr;  ///< May be null; else `span` of its file follows the head.
    ByteSpan span{};

    bool empty() const { return head.empty() && span.size() == 0; }
  };

  /// Sends all of it, what can be sent at once before it returns; false if that failed or the file
  /// is no longer intact. Then the peer has been sent too little, and the connection must be cut.
  /// What is pointed to must stay until then.
  Awaitable<bool> send(Parcel parcel);
  /// The first half of send(), without waiting: sends what can be sent now and takes it off
  /// `parcel`. Often that is all, and no coroutine is needed. Says what is to be waited for, or
  /// `moved` once all is sent.
  WireStep::Kind push(Parcel& parcel);
  /// The other half: what push() left in `parcel` when it said `need`.
  Awaitable<bool> send_rest(Parcel parcel, WireStep::Kind need);
  /// Whether the last send failed because the peer took no byte for too long.
  bool send_timed_out() const { return send_timed_out_; }
  /// Handed to the kernel so far, without what TLS adds.
  std::uint64_t sent_bytes() const { return sent_bytes_; }

  /// Ends the connection. What was sent still arrives if the peer has not sent anything unread.
  void close();

  /// Ends the connection so that the peer gets all that was sent, even if it was still sending.
  Awaitable<void> close_gently();

  /// Ends it at once: the peer gets a reset, the kernel drops what it had queued.
  void reset();

 private:
  Awaitable<std::size_t> receive_decrypted(std::span<char> into);
  Awaitable<bool> wait_to_receive(WireStep::Kind need);
  WireStep write(const Parcel& parcel);
  WireStep write_record(const Parcel& parcel);
  Awaitable<bool> wait_to_send(WireStep::Kind need);
  bool has_read();
  void expect_progress();
  void check_progress();
  int unsent_bytes();
  void set_send_buffer(int bytes);

  Socket socket_;
  Executor executor_;
  std::optional<TlsStream> tls_;
  const std::chrono::milliseconds send_timeout_;
  const std::chrono::milliseconds progress_interval_;
  const int send_buffer_bytes_;
  const int live_send_buffer_bytes_;
  int send_buffer_ = 0;  // as it is set now
  std::shared_ptr<Deadline> receive_deadline_;
  std::shared_ptr<Deadline> send_deadline_;
  std::uint64_t sent_bytes_ = 0;
  int unsent_ = 0;  // bytes that the peer had not taken at the last look; 0: not looked yet
  Deadline::Clock::time_point progressed_{};  // when it was seen to take some
  bool timed_out_ = false;
  bool interrupted_ = false;
  bool send_timed_out_ = false;
};

}  // namespace pmesh
