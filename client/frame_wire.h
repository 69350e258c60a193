// What carries the frames of docs/protocol.md, section 3: a TCP connection or a WebSocket.
//
// Threads: belongs to one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "client/transport.h"

namespace pmesh {

class FrameWire {
 public:
  virtual ~FrameWire() = default;

  /// The peer's name for messages: "host:port".
  virtual std::string peer() const = 0;

  /// Connects; an earlier connection is closed.
  virtual TransportStatus connect() = 0;
  virtual bool is_open() const = 0;
  virtual void close() = 0;

  /// Precondition of both: is_open(). They close the wire when they fail.
  virtual TransportStatus send(std::span<const Bytes> frames) = 0;
  /// Receives at least one byte of the peer's frames into `buffer`; `count` is how many, 0 if the
  /// peer has ended the conversation.
  virtual TransportStatus receive(std::span<std::uint8_t> buffer, std::size_t& count) = 0;
};

}  // namespace pmesh
