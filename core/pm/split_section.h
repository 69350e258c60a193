// What a bit of a chunk's splits tells.
#pragma once

#include <cstddef>
#include <cstdint>

namespace pmesh {

enum class SplitSection : std::uint8_t {
  batches,      ///< Counts and parameters of batches.
  marks,        ///< Which vertices are split.
  cuts,         ///< The cut neighbours.
  positions,    ///< Of added vertices.
  relocations,  ///< Of kept vertices.
};
inline constexpr std::size_t kSplitSections = 5;

}  // namespace pmesh
