#include "tests/client/sample.h"

#include <cmath>
#include <cstdlib>
#include <utility>

#include "core/decimate/decimate.h"
#include "core/io/export.h"
#include "core/mesh/half_edge_mesh.h"
#include "core/mesh/lattice.h"
#include "core/pm/base_codec.h"
#include "core/pm/encoder.h"
#include "core/pm/stream_decoder.h"
#include "protocol/apply_wish.h"
#include "tests/fixtures/measured.h"
#include "tests/fixtures/shapes.h"

namespace pmesh::test {

Bytes make_pm_file(const IndexedMesh& mesh, std::uint32_t base_faces) {
  const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
  const Lattice lattice = *make_lattice(mesh.positions, 20);
  std::vector<Vec3i> points;
  for (const Vec3d& p : mesh.positions) points.push_back(lattice.quantise(p));
  DecimateOptions options;
  options.base_faces = base_faces;
  const Decimation decimation =
      decimate(*HalfEdgeMesh::build(mesh.triangles, vertices), mesh.positions, options);
  return *encode({decimation.mesh, points, decimation.log, lattice, "melod", "", ""});
}

const Bytes& sample_file() {
  static const Bytes file = [] {
    Bytes made = make_pm_file(shapes::bumped(shapes::grid(100, 100), 0.02));
    const FileIndex index = **parse_prologue(made);
    return with_errors(std::move(made), halving_errors(index, 8));
  }();
  return file;
}

const FileIndex& sample_index() {
  static const FileIndex index = **parse_prologue(sample_file());
  return index;
}

const Bytes& other_file() {
  static const Bytes file = make_pm_file(shapes::bumped(shapes::grid(100, 100), 0.03));
  return file;
}

LodRequest wish(const char* query) { return *parse_wish(query); }

Bytes extracted(const Bytes& pm, const LodRequest& wish) {
  StreamDecoder decoder(decode_base);
  if (!decoder.feed(pm) || !apply_wish(wish, decoder.index(), decoder.mesh())) std::abort();
  return *format_mesh(ExportFormat::ply, decoder.mesh().snapshot(), decoder.index().header.lattice);
}

}  // namespace pmesh::test
