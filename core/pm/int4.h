// Four 32-bit integers at once: a point's coordinates and a 0. Compilers make vector instructions
// of them where there are such, WebAssembly's included.
//
// Threads: plain values; no shared state.
#pragma once

#include <cstdint>

#include "core/base/vec3.h"
#include "core/pm/fixed_point.h"

namespace pmesh {

using Int4 [[gnu::vector_size(16)]] = std::int32_t;

inline Int4 int4(Vec3i a) { return Int4{a.x, a.y, a.z, 0}; }

inline Int4 magnitude(Int4 a) { return a < 0 ? -a : a; }

inline Int4 clamp_to(Int4 a, std::int32_t most) {
  a = a < most ? a : Int4{} + most;
  return a > -most ? a : Int4{} - most;
}

inline Vec3l widen(const Int4& a) { return {a[0], a[1], a[2]}; }

inline std::int64_t dot(const Int4& a, Vec3l b) { return dot(widen(a), b); }

}  // namespace pmesh
