#include "core/io/clean.h"

#include <utility>
#include <vector>

#include "core/base/ids.h"
#include "core/io/manifold.h"
#include "core/io/repeats.h"
#include "core/io/weld.h"

namespace pmesh {
namespace {

void drop_faces(IndexedMesh& mesh, CleanReport& report) {
  const DroppedFaces dropped = drop_repeats(mesh.triangles);
  report.degenerate += dropped.degenerate;
  report.duplicate += dropped.duplicate;
}

void cut_apart(IndexedMesh& mesh, CleanReport& report) {
  const CutReport cut = cut_to_manifold(mesh);
  report.opposite_pairs = cut.opposite_pairs;
  report.nonmanifold_edges_cut = cut.nonmanifold_edges_cut;
  report.winding_edges_cut = cut.winding_edges_cut;
  report.nonmanifold_vertices_cut = cut.nonmanifold_vertices_cut;
  report.vertices_added = cut.vertices_added;
}

// Drops the vertices that no face uses; the others keep their order. Returns how many.
std::uint64_t drop_unused_vertices(IndexedMesh& mesh) {
  std::vector<std::uint32_t> new_ids(mesh.positions.size(), kNoIndex);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) new_ids[v] = 0;
  }
  std::uint32_t used = 0;
  for (std::size_t v = 0; v < new_ids.size(); ++v) {
    if (new_ids[v] == kNoIndex) continue;
    mesh.positions[used] = mesh.positions[v];
    new_ids[v] = used++;
  }
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = new_ids[v];
  }
  mesh.positions.resize(used);
  return new_ids.size() - used;
}

}  // namespace

CleanedMesh clean(ImportedMesh imported) {
  CleanedMesh cleaned{std::move(imported.mesh), {}};
  auto& [mesh, report] = cleaned;
  drop_faces(mesh, report);  // before welding, too: a repeated face would hide a border
  report.welded =
      weld_vertices(mesh, imported.is_soup ? WeldScope::all_vertices : WeldScope::border_vertices);
  drop_faces(mesh, report);
  cut_apart(mesh, report);
  report.unreferenced = drop_unused_vertices(mesh) - report.welded;
  return cleaned;
}

}  // namespace pmesh
