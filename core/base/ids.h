// Typed 32-bit ids. A VertexId cannot be passed where a FaceId is wanted.
#pragma once

#include <compare>
#include <cstdint>

namespace pmesh {

inline constexpr std::uint32_t kNoIndex = 0xFFFF'FFFFu;

template <class Tag>
struct Id {
  std::uint32_t value = kNoIndex;

  constexpr Id() = default;
  constexpr explicit Id(std::uint32_t v) : value(v) {}

  /// False for the default id, which names nothing.
  constexpr bool valid() const { return value != kNoIndex; }
  friend constexpr auto operator<=>(Id, Id) = default;
};

using VertexId = Id<struct VertexTag>;
using FaceId = Id<struct FaceTag>;
using HalfEdgeId = Id<struct HalfEdgeTag>;

}  // namespace pmesh
