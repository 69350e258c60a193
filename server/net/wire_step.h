// What one attempt to move bytes through a non-blocking socket came to.
#pragma once

#include <cstddef>
#include <cstdint>

namespace pmesh {

struct WireStep {
  enum Kind : std::uint8_t {
    moved,        ///< `count` bytes, at least one.
    must_read,    ///< Nothing: try again when the socket can be read.
    must_write,   ///< Nothing: try again when the socket can be written.
    interrupted,  ///< Nothing: try again at once.
    ended,        ///< The connection is over, or broken.
  };
  Kind kind = ended;
  std::size_t count = 0;
};

}  // namespace pmesh
