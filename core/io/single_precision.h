// Which positions of a lattice single precision can hold, and how exports round them.
//
// Threads: pure functions and plain values.
#pragma once

#include "core/base/vec3.h"
#include "core/mesh/lattice.h"

namespace pmesh {

/// The largest coordinate, by magnitude, that a point of `lattice` can have.
double largest_coordinate(const Lattice& lattice);

/// The most by which rounding to single precision moves a number of at most this magnitude.
double float_rounding(double largest);

/// Whether single precision keeps every position of `lattice` to within 1/8 of a step. Exports
/// store floats if so, else doubles: a pure function of the lattice, the same for every LOD.
bool fits_single_precision(const Lattice& lattice);

/// Not inline: g++ 12 takes a conversion to floats and back, of several doubles at once, for none.
Vec3<float> to_single(Vec3d p);

/// The positions of lattice points as exports write them: rounded to floats if those suffice.
class ExportedPositions {
 public:
  explicit ExportedPositions(const Lattice& lattice)
      : lattice_(lattice), single_(fits_single_precision(lattice)) {}

  Vec3d operator()(Vec3i point) const {
    const Vec3d p = lattice_.position(point);
    if (!single_) return p;
    const Vec3<float> rounded = to_single(p);
    return {rounded.x, rounded.y, rounded.z};
  }

 private:
  Lattice lattice_;
  bool single_;
};

}  // namespace pmesh
