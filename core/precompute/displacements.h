// How far quantisation and export have moved the vertices of a mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/vec3.h"
#include "core/io/export.h"
#include "core/mesh/indexed_mesh.h"
#include "core/mesh/lattice.h"

namespace pmesh {

/// A hash table by lattice point. Threads: const members may be called at the same time.
class Displacements {
 public:
  Displacements(const IndexedMesh& original, const Lattice& lattice);

  /// Of the vertices of the original at `point`: the largest. Precondition: there is one.
  double at(Vec3i point) const { return entries_[slot_of(point)].length; }

 private:
  struct Entry {
    Vec3i point;
    double length = kFree;
  };
  static constexpr double kFree = -1;

  std::size_t slot_of(Vec3i point) const;  // where it is or may be put

  std::vector<Entry> entries_;  // a power of two
};

}  // namespace pmesh
