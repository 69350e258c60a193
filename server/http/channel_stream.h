// A channel as the stream that Beast's WebSockets are made on, so that they too have its timeouts
// and its TLS.
#pragma once

#include <span>

#include <boost/asio/async_result.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/role.hpp>

#include "server/net/channel.h"

namespace pmesh {

/// Models Beast's AsyncReadStream and AsyncWriteStream. Threads: as Channel.
class ChannelStream {
 public:
  using executor_type = Executor;
  using error_code = boost::system::error_code;

  explicit ChannelStream(Channel& channel) : channel_(&channel) {}

  executor_type get_executor() { return channel_->executor(); }
  Channel& channel() { return *channel_; }

  template <class Buffers, class Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    const boost::asio::mutable_buffer first = *boost::asio::buffer_sequence_begin(buffers);
    return initiate(receive({static_cast<char*>(first.data()), first.size()}),
                    std::forward<Token>(token));
  }

  template <class Buffers, class Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    auto next = boost::asio::buffer_sequence_begin(buffers);
    const auto end = boost::asio::buffer_sequence_end(buffers);
    while (next != end && boost::asio::const_buffer(*next).size() == 0) ++next;
    const boost::asio::const_buffer first =
        next == end ? boost::asio::const_buffer() : boost::asio::const_buffer(*next);
    return initiate(send({static_cast<const std::uint8_t*>(first.data()), first.size()}),
                    std::forward<Token>(token));
  }

 private:
  Awaitable<std::size_t> receive(std::span<char> into) {
    if (into.empty()) co_return 0;
    const std::size_t count = co_await channel_->receive(into, Deadline::Clock::time_point::max());
    co_return count;
  }
  Awaitable<std::size_t> send(ByteView bytes) {
    const Channel::Parcel parcel{bytes};
    const bool sent = co_await channel_->send(parcel);
    co_return sent ? bytes.size() : 0;
  }

  /// Runs `work`, and hands what it gives to the token's handler; nothing means the end.
  template <class Token>
  auto initiate(Awaitable<std::size_t> work, Token&& token) {
    const auto start = [this](auto handler, Awaitable<std::size_t> started) {
      auto done = [executor = get_executor(), handler = std::move(handler)](
                      const std::exception_ptr&, std::size_t count) mutable {
        const error_code error = count > 0 ? error_code() : boost::asio::error::eof;
        boost::asio::post(executor, [handler = std::move(handler), error, count]() mutable {
          std::move(handler)(error, count);
        });
      };
      boost::asio::co_spawn(get_executor(), std::move(started), std::move(done));
    };
    return boost::asio::async_initiate<Token, void(error_code, std::size_t)>(start, token,
                                                                             std::move(work));
  }

  Channel* channel_;
};

/// How Beast ends a stream: the conversation closes the channel itself.
inline void beast_close_socket(ChannelStream& stream) { stream.channel().close(); }
inline void teardown(boost::beast::role_type, ChannelStream&, boost::system::error_code& error) {
  error = {};
}
template <class Handler>
void async_teardown(boost::beast::role_type, ChannelStream& stream, Handler&& handler) {
  boost::asio::post(stream.get_executor(), [handler = std::forward<Handler>(handler)]() mutable {
    std::move(handler)(boost::system::error_code());
  });
}

}  // namespace pmesh
