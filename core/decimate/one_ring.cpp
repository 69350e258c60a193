#include "core/decimate/one_ring.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/decimate/wide_vectors.h"

namespace pmesh {
namespace {

// Loops run over whole blocks of four faces, so that they are vectorised without a tail: the rows
// have the slack, and nobody reads it.
constexpr std::size_t whole_blocks(std::size_t count) { return (count + 3) / 4 * 4; }

// Unit normals and areas of the faces (tip, i, i+1) for i below `count`. The rows are parameters of
// their own so that the compiler may believe that they do not overlap.
PMESH_WIDE_VECTORS
void make_faces(const double* __restrict x, const double* __restrict y, const double* __restrict z,
                Vec3d tip, std::size_t count, double* __restrict nx, double* __restrict ny,
                double* __restrict nz, double* __restrict area) {
  const std::size_t blocks = whole_blocks(count);
  for (std::size_t i = 0; i < blocks; ++i) {
    const double ax = x[i] - tip.x, ay = y[i] - tip.y, az = z[i] - tip.z;
    const double bx = x[i + 1] - tip.x, by = y[i + 1] - tip.y, bz = z[i + 1] - tip.z;
    const double cx = ay * bz - az * by, cy = az * bx - ax * bz, cz = ax * by - ay * bx;
    const double doubled_area = std::sqrt(cx * cx + cy * cy + cz * cz);
    const double aa = ax * ax + ay * ay + az * az, bb = bx * bx + by * by + bz * bz;
    const double limit = kZeroAreaRatio * (aa > bb ? aa : bb);
    const double inverse = 1 / doubled_area;
    const double to_unit = doubled_area > limit ? inverse : 0;
    nx[i] = to_unit * cx;
    ny[i] = to_unit * cy;
    nz[i] = to_unit * cz;
    area[i] = 0.5 * doubled_area;
  }
}

PMESH_WIDE_VECTORS
void dot_products(const double* __restrict nx, const double* __restrict ny,
                  const double* __restrict nz, MovedFaces& moved) {
  const std::size_t blocks = whole_blocks(moved.count);
  for (std::size_t k = 0; k < blocks; ++k) {
    moved.cosine[k] = nx[k] * moved.nx[k] + ny[k] * moved.ny[k] + nz[k] * moved.nz[k];
  }
}

// Repeats the first `period` elements of a row once, by whole blocks.
void repeat(OneRing::Row& row, std::uint32_t period) {
  for (std::size_t i = 0; i < period; i += 4) {
    double block[4];
    std::memcpy(block, row.data() + i, sizeof block);
    std::memcpy(row.data() + period + i, block, sizeof block);
  }
}

}  // namespace

bool gather_neighbours(const HalfEdgeMesh& mesh, VertexId v, OneRing& ring) {
  const HalfEdgeId first = mesh.outgoing(v);
  HalfEdgeId last, h = first;
  std::uint32_t faces = 0;
  do {
    if (faces == OneRing::kMaxFaces) return false;
    ring.ids[faces++] = mesh.target(h);
    last = h;
    h = mesh.rotate_ccw(h);
  } while (h.valid() && h != first);
  ring.centre = v;
  ring.faces = faces;
  ring.border = !h.valid();
  ring.neighbours = faces;
  if (ring.border) ring.ids[ring.neighbours++] = mesh.apex(last);
  std::fill_n(ring.ids.begin() + ring.neighbours, OneRing::kIdBlock, VertexId());
  return true;
}

void gather_positions(const WorkingMesh& work, OneRing& ring) {
  const Vec3d centre = work.position(ring.centre);
  const double scale = work.frame().scale;
  const auto relative = [&](VertexId v) { return scale * (work.position(v) - centre); };
  ring.origin = work.frame().to_unit(centre);
  for (std::uint32_t i = 0; i < ring.neighbours; ++i) {
    const Vec3d p = relative(ring.ids[i]);
    ring.x[i] = p.x;
    ring.y[i] = p.y;
    ring.z[i] = p.z;
  }
  if (ring.border) {
    ring.beyond_first = relative(work.borders().next(ring.ids[0]));
    ring.beyond_last = relative(work.borders().previous(ring.ids[ring.neighbours - 1]));
  } else {
    for (OneRing::Row* row : {&ring.x, &ring.y, &ring.z}) repeat(*row, ring.faces);
  }
}

void gather_faces(OneRing& ring) {
  make_faces(ring.x.data(), ring.y.data(), ring.z.data(), {}, ring.faces, ring.nx.data(),
             ring.ny.data(), ring.nz.data(), ring.area.data());
  if (ring.border) return;
  for (OneRing::Row* row : {&ring.nx, &ring.ny, &ring.nz, &ring.area}) repeat(*row, ring.faces);
}

void move_faces(const OneRing& ring, std::uint32_t head, MovedFaces& moved) {
  if (ring.border) {
    moved.first = head == 0 ? 1 : 0;
    moved.count = ring.faces - 1;
  } else {
    moved.first = head + 1;
    moved.count = ring.faces - 2;
  }
  make_faces(ring.x.data() + moved.first, ring.y.data() + moved.first, ring.z.data() + moved.first,
             ring.position(head), moved.count, moved.nx.data(), moved.ny.data(), moved.nz.data(),
             moved.area.data());
  dot_products(ring.nx.data() + moved.first, ring.ny.data() + moved.first,
               ring.nz.data() + moved.first, moved);
}

}  // namespace pmesh
