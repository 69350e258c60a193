#include "core/pm/split_encoder.h"

#include <cassert>

namespace pmesh {
namespace {

// The longest record: kind, half-edge, 255 moved faces, and all coordinates escaped.
constexpr std::uint64_t kMostSiteBits = 2 + 32 + 15;
constexpr std::uint64_t kMostPointBits = 3 * (kRiceEscape + 32);
static_assert(kMostSiteBits + kMostPointBits <= 8 * kMaxSplitBytes);
static_assert(kMostSiteBits + 2 * kMostPointBits <= 8 * kMaxRelocatingSplitBytes);

}  // namespace

SplitEncoder::SplitEncoder(const FileHeader& header)
    : header_(header),
      added_(make_point_model(header.lattice.bits)),
      kept_(make_point_model(header.lattice.bits)) {}

void SplitEncoder::put(const VertexSplit& split, const RefinableMesh& mesh) {
  const SplitSite& site = split.site;
  const bool interior = site.kind == SplitKind::interior;
  assert(interior || header_.has_borders);
  assert(split.relocation == Vec3i{} || header_.has_relocations);
  assert(site.moved_faces <= kMaxMovedFaces);
  if (header_.has_borders) {
    bits_.put(interior ? 0 : 1, 1);
    if (!interior) bits_.put(site.kind == SplitKind::border_last ? 1 : 0, 1);
  }
  bits_.put(site.half_edge.value, bits_for(3 * mesh.face_count()));
  put_exp_golomb(site.moved_faces - (interior ? 1u : 0u));
  const Vec3i kept = mesh.positions()[kept_vertex(mesh.connectivity(), site).value];
  put_point(split.position, kept, added_);
  if (!header_.has_relocations) return;
  put_point(kept + split.relocation, predicted_kept(kept, split.position), kept_);
}

void SplitEncoder::put_point(Vec3i point, Vec3i predicted, PointModel& model) {
  const Vec3i residual = point - predicted;
  put_rice(zigzag(residual.x), model[0]);
  put_rice(zigzag(residual.y), model[1]);
  put_rice(zigzag(residual.z), model[2]);
}

void SplitEncoder::put_exp_golomb(std::uint32_t value) {
  int width = kMovedFacesOrder;
  value += 1u << kMovedFacesOrder;
  for (; value >> (width + 1) != 0; ++width) bits_.put(1, 1);
  bits_.put(0, 1);
  bits_.put(value - (1u << width), width);
}

void SplitEncoder::put_rice(std::uint32_t value, RiceModel& model) {
  const int parameter = model.parameter();
  const std::uint32_t quotient = value >> parameter;
  if (quotient >= kRiceEscape) {
    bits_.put((1u << kRiceEscape) - 1, kRiceEscape);
    bits_.put(value, 32);
  } else {
    bits_.put((1u << quotient) - 1, static_cast<int>(quotient) + 1);
    bits_.put(value & ((1u << parameter) - 1), parameter);
  }
  model.update(value);
}

}  // namespace pmesh
