#include "core/pm/split_encoder.h"

#include <cassert>

namespace pmesh {

SplitEncoder::SplitEncoder(const FileHeader& header)
    : header_(header),
      differences_{RiceModel(header.lattice.bits), RiceModel(header.lattice.bits),
                   RiceModel(header.lattice.bits)} {}

void SplitEncoder::put(const VertexSplit& split, const RefinableMesh& mesh) {
  const SplitSite& site = split.site;
  const bool interior = site.kind == SplitKind::interior;
  assert(interior || header_.has_borders);
  assert(site.moved_faces <= kMaxMovedFaces);
  if (header_.has_borders) {
    bits_.put(interior ? 0 : 1, 1);
    if (!interior) bits_.put(site.kind == SplitKind::border_last ? 1 : 0, 1);
  }
  bits_.put(site.half_edge.value, bits_for(3 * mesh.face_count()));
  put_exp_golomb(site.moved_faces - (interior ? 1u : 0u));
  const Vec3i from = mesh.positions()[kept_vertex(mesh.connectivity(), site).value];
  const Vec3i difference = split.position - from;
  put_rice(zigzag(difference.x), differences_[0]);
  put_rice(zigzag(difference.y), differences_[1]);
  put_rice(zigzag(difference.z), differences_[2]);
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
