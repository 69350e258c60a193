// The connected components of a decimated mesh, in the order in which a PM file brings them: the
// large ones first.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/decimate/collapse_log.h"
#include "core/mesh/indexed_mesh.h"

namespace pmesh {

/// Threads: const members may be called at the same time.
class Components {
 public:
  /// `base` is what the collapses of `log` left; `positions` are by vertex of the decimated mesh.
  /// The size of a component is the diagonal of its bounding box at full resolution. The largest
  /// comes first, then the others by size, in classes of 1 to the root of 2; those of a class come
  /// scattered over the mesh, so that any number of them shows all of it.
  Components(const HalfEdgeMesh& base, std::span<const Vec3i> positions, const CollapseLog& log);

  std::size_t count() const { return starts_.size() - 1; }
  /// What the components `first` to `end` - 1 have in the base.
  std::size_t vertices(std::size_t first, std::size_t end) const {
    return starts_[end].vertex - starts_[first].vertex;
  }
  std::size_t faces(std::size_t first, std::size_t end) const {
    return starts_[end].triangle - starts_[first].triangle;
  }

  struct Part {
    LatticeMesh mesh;
    std::vector<VertexId> originals;  ///< By vertex: its id in the decimated mesh.
  };
  /// The components `first` to `end` - 1 in the base, in the order of its ids.
  Part part(std::size_t first, std::size_t end) const;
  /// The collapses in the components `first` to `end` - 1: places in the log, ascending.
  std::vector<std::uint32_t> collapses(std::size_t first, std::size_t end) const;

 private:
  struct Start {
    std::size_t vertex, triangle, collapse;
  };

  std::span<const Vec3i> positions_;
  LiveMesh live_;
  // Live vertices, live triangles and collapses, those of one component together, in order.
  std::vector<std::uint32_t> vertices_, triangles_, collapses_;
  std::vector<Start> starts_;  // by component, and the ends
};

}  // namespace pmesh
