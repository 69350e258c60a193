// A transport without a wire, that misbehaves as told.
#pragma once

#include <algorithm>
#include <functional>
#include <random>
#include <vector>

#include "client/transport.h"

namespace pmesh::test {

class ScriptedTransport : public Transport {
 public:
  explicit ScriptedTransport(Bytes bytes) : file(std::move(bytes)) {}

  Bytes file;
  std::optional<ContentHash> hash;         ///< Told by open().
  bool ignores_ranges = false;             ///< Begins at 0, as a host that answers 200.
  std::size_t block_bytes = 1000;          ///< Given to the sink at a time.
  std::function<std::size_t()> cut_after;  ///< If set: bytes until a read is cut.
  std::optional<TransportError> open_error;
  std::uint64_t left_out = 0;  ///< Bytes skipped before what was asked for.

  int opens = 0;
  std::vector<ReadRequest> reads;

  TransportStatus open() override {
    ++opens;
    remote_ = {hash, file.size()};
    return open_error;
  }

  TransportStatus read(const ReadRequest& request, const ByteSink& sink) override {
    reads.push_back(request);
    const std::uint64_t asked = request.end.value_or(request.from + kMaxPrologueBytes);
    const std::uint64_t end = ignores_ranges ? file.size() : std::min(asked, file.size());
    std::size_t allowed = cut_after ? cut_after() : file.size();
    std::uint64_t at = ignores_ranges ? 0 : request.from + left_out;
    while (at < end) {
      const std::size_t count = std::min({block_bytes, std::size_t(end - at), allowed});
      if (count > 0 && !sink(at, ByteView(file).subspan(at, count))) return std::nullopt;
      at += count;
      allowed -= count;
      if (allowed == 0) return retryable_error(runtime_error("connection lost"));
    }
    return std::nullopt;
  }
};

/// Random lengths below `most`, the same for the same seed.
inline std::function<std::size_t()> random_cuts(std::uint32_t seed, std::size_t most) {
  return [engine = std::mt19937(seed), most]() mutable { return 1 + engine() % most; };
}

}  // namespace pmesh::test
