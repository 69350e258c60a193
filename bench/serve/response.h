// Reads the answers of one connection: counts their bytes, and compares them with what is known.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace pmesh::bench {

class Response {
 public:
  enum class Step { more, done, bad };

  /// `expected` is the body, which is then compared, or empty.
  explicit Response(std::string_view expected = {}) : expected_(expected) {}

  /// Takes the next bytes. Bad: no HTTP, no Content-Length, more than the answer, or other bytes
  /// than expected in an answer of 200 or 206.
  Step feed(std::string_view bytes);

  int status() const { return status_; }  ///< 0 until the head is whole.

 private:
  Step take_head(std::string_view bytes);
  Step take_body(std::string_view bytes);

  std::string_view expected_;
  std::string head_;
  int status_ = 0;
  std::uint64_t body_bytes_ = 0;
  std::uint64_t taken_ = 0;
};

}  // namespace pmesh::bench
