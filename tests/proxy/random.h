// The proxy's dice: a stream of random numbers of its own for every connection, the same for the
// same seed on every machine.
//
// Threads: plain values.
#pragma once

#include <cstdint>

namespace pmesh::test {

/// SplitMix64 (Steele, Lea and Flood 2014, figure 17).
class Random {
 public:
  /// The stream of connection number `connection` of a proxy with this seed.
  Random(std::uint64_t seed, std::uint64_t connection) : state_(seed) {
    state_ = next() ^ connection;
    state_ = next();
  }

  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
    return z ^ (z >> 31);
  }

  /// Less than `bound`, which is not 0.
  std::uint64_t below(std::uint64_t bound) { return next() % bound; }

  /// True with the given probability, from 0 to 1.
  bool chance(double probability) {
    return static_cast<double>(next() >> 11) * 0x1p-53 < probability;
  }

 private:
  std::uint64_t state_;
};

}  // namespace pmesh::test
