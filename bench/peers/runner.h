// The frame of the peer programs: every tool is fed, timed and measured by the same code.
//
//   peer_TOOL VARIANT MESH LEVEL... [--write PREFIX]
//
// MESH (PLY, OBJ, STL or OFF) is imported and cleaned as `pmesh precompute` does it, so that every
// tool gets the same surface. A LEVEL is a number of faces (1596) or a share of the cleaned mesh's
// (0.5%). Without --write the tool goes to the last, coarsest level at once; with it, the mesh at
// each level is written to PREFIX_LEVEL.ply (no percent sign, double precision).
//
// Prints one JSON object: tool, variant, faces, seconds (CPU time of the decimating thread, from
// the tool's loaded mesh to the level: quadrics, heap and loop, no I/O), mesh_bytes (resident: the
// loaded mesh), peak_bytes (the most above it while decimating), and lods [{level, faces, file}].
// Seconds and peak mean little with --write.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/mesh/indexed_mesh.h"

namespace pmesh::bench {

/// Ends the program with `message` on standard error.
[[noreturn]] void fail(const std::string& message);

/// `mesh` with the vertices that no triangle uses taken out, the others in the order of first use.
IndexedMesh without_unused_vertices(const IndexedMesh& mesh);

struct Level {
  std::string label;
  std::uint32_t faces = 0;
};

/// The levels still to be written, finest first; none in a run that is timed.
class Lods {
 public:
  Lods() = default;
  Lods(std::vector<Level> levels, std::string prefix);

  /// Whether a mesh of `live_faces` faces is the first to fit the next level.
  bool due(std::uint32_t live_faces) const {
    return next_ < levels_.size() && live_faces <= levels_[next_].faces;
  }

  /// Writes `mesh` as the next level.
  void take(const IndexedMesh& mesh);

  /// The same, unless the tool stopped short of that level: then it is left out.
  void take_if_due(const IndexedMesh& mesh) {
    if (due(static_cast<std::uint32_t>(mesh.triangles.size()))) take(mesh);
  }

  std::span<const Level> levels() const { return levels_; }

  struct Written {
    std::string label;
    std::uint64_t faces = 0;
    std::string file;
  };
  std::span<const Written> written() const { return written_; }

 private:
  std::vector<Level> levels_;
  std::string prefix_;
  std::size_t next_ = 0;
  std::vector<Written> written_;
};

/// One tool, in one of its variants.
class Peer {
 public:
  virtual ~Peer() = default;

  /// Builds the tool's own mesh. The argument does not outlive the call.
  virtual void load(const IndexedMesh& mesh) = 0;

  /// Decimates the loaded mesh to at most `faces` faces, or as far as the tool can, and on the way
  /// gives each mesh that is due to `lods`.
  virtual void decimate(std::uint32_t faces, Lods& lods) = 0;
};

/// The main function of a peer program. `peer` is to be set up for the variant, or to fail().
int run_peer(std::string_view tool, int argc, char** argv,
             const std::function<Peer&(const std::string& variant)>& peer);

}  // namespace pmesh::bench
