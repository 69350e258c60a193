// Mesh files out: PLY (binary little-endian) and OBJ.
#pragma once

#include <string>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/base/vec3.h"
#include "core/io/import.h"
#include "core/mesh/indexed_mesh.h"
#include "core/mesh/lattice.h"

namespace pmesh {

/// Whether single precision keeps every position of `lattice` to within 1/8 of a step. Exports
/// store floats if so, else doubles: a pure function of the lattice, the same for every LOD.
bool fits_single_precision(const Lattice& lattice);

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
  // Not inline: g++ 12 takes a conversion to floats and back, of several doubles at once, for none.
  static Vec3<float> to_single(Vec3d p);

  Lattice lattice_;
  bool single_;
};

/// `mesh` as a file's bytes: the same bytes for the same mesh, lattice and format. Triangles and
/// vertices keep their order. Precondition: format is ply or obj.
Bytes format_mesh(MeshFormat format, const LatticeMesh& mesh, const Lattice& lattice);

/// Writes format_mesh() to `path` (format by its extension) through core/files/atomic_file.h: on
/// any error the old file, if there was one, is still there.
Status export_mesh(const std::string& path, const LatticeMesh& mesh, const Lattice& lattice);

}  // namespace pmesh
