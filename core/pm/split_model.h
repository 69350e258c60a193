// What the split coder has learnt so far in a file, and the parameters of the batch at hand: the
// contexts of every kind of decision (docs/pm-format.md, "Contexts"). Encoder and decoder keep one
// each, alike at every split.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/pm/adaptive_bit.h"
#include "core/pm/fan_choice.h"
#include "core/pm/patch.h"

namespace pmesh {

/// What an encoder sends ahead of a batch.
struct BatchParameters {
  Predictor predictor;
  FanWeights fan;
};

/// Before a file's first batch.
inline BatchParameters initial_parameters() {
  BatchParameters initial{{{}, {32, 32}}, {{72, -74, 96}}};
  initial.predictor.fans.fill({{4, -2, 2, 32}, {27, 4}});
  return initial;
}

/// Weights lie in [-127, 127].
inline constexpr std::int64_t kMostWeight = 127;

/// Bit lengths of a number around the one that its class makes likely.
struct LengthModel {
  AdaptiveBit above;
  std::array<AdaptiveBit, 8> up, down;
};

struct SplitModel {
  static constexpr std::uint32_t kValences = 16, kFree = 12, kFanSizes = 10;

  // Marks: border or not, valence, free faces.
  std::array<std::array<std::array<AdaptiveBit, kFree>, kValences>, 2> mark;
  std::array<AdaptiveBit, 32> gap_length;  // from one named vertex to the next
  AdaptiveBit goes_on, sweeps;             // with the last sweep? if not, is it a new sweep?

  // Cut neighbours.
  std::array<AdaptiveBit, kValences> interior;  // of a border vertex's split; by valence
  AdaptiveBit last;                             // border_last rather than border_first
  // Is the fan larger than this? Interior or not, size so far, valence, largest possible.
  std::array<std::array<std::array<std::array<AdaptiveBit, kFanSizes>, kValences>, kFanSizes>, 2>
      larger;
  // Is it this candidate? Its rank, its lead over the next and over the one after.
  std::array<std::array<std::array<AdaptiveBit, 4>, 8>, 4> candidate;

  // Positions and relocations: tangential and normal parts.
  struct Residuals {
    std::array<std::array<LengthModel, 64>, 2> length;  // by class
    std::array<std::array<AdaptiveBit, 32>, 2> second;  // the bit below the leading one; by length
  };
  Residuals added, kept;

  std::array<AdaptiveBit, 8> weight_length;  // of a change of a parameter
  BatchParameters parameters = initial_parameters();
};

}  // namespace pmesh
