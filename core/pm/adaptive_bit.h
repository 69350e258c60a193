// The probability model of one binary decision.
#pragma once

#include <array>
#include <cstdint>

namespace pmesh {

/// Estimates how often a decision is 1 from how often it was, as the mean of two averages: one over
/// about the last 256 decisions, one over about 32. As long as there were fewer, both count all
/// alike. Integer arithmetic: the same on every machine.
class AdaptiveBit {
 public:
  /// Chance of a 1, in 65536ths; never 0, never 65536.
  std::uint32_t one() const { return (std::uint32_t{slow_} + fast_) >> 1; }

  void update(bool bit) {
    const std::uint32_t rate = kRates[seen_];
    move(slow_, rate, bit);
    move(fast_, rate > kFastRate ? rate : kFastRate, bit);
    if (seen_ < kRates.size() - 1) ++seen_;
  }

 private:
  static void move(std::uint16_t& chance, std::uint32_t rate, bool bit) {
    const std::uint32_t step = (bit ? 65536 - chance : chance) * rate >> 16;
    chance = static_cast<std::uint16_t>(bit ? chance + step : chance - step);
  }

  // After n decisions the next one weighs 1 / (n + 1.5), in 65536ths.
  static constexpr std::array<std::uint16_t, 256> kRates = [] {
    std::array<std::uint16_t, 256> rates{};
    for (std::uint32_t n = 0; n < rates.size(); ++n) {
      rates[n] = static_cast<std::uint16_t>(2 * 65536 / (2 * n + 3));
    }
    return rates;
  }();
  static constexpr std::uint32_t kFastRate = 65536 / 32;

  std::uint16_t slow_ = 1 << 15, fast_ = 1 << 15;
  std::uint16_t seen_ = 0;
};

}  // namespace pmesh
