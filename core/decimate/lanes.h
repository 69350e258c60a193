// Vectors of a double for each of RingLanes' lanes. To be used in functions that are
// PMESH_WIDE_VECTORS; not to be passed to others by value, since processors without wide vectors
// pass them otherwise.
#pragma once

#include <cstdint>

#include "core/decimate/ring_lanes.h"
#include "core/decimate/wide_vectors.h"

namespace pmesh {

using Lanes [[gnu::vector_size(sizeof(RingLanes::Row)), gnu::may_alias]] = double;

inline Lanes& lanes_of(RingLanes::Row& row) { return *reinterpret_cast<Lanes*>(row.data()); }
inline const Lanes& lanes_of(const RingLanes::Row& row) {
  return *reinterpret_cast<const Lanes*>(row.data());
}

}  // namespace pmesh
