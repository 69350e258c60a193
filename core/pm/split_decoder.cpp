#include "core/pm/split_decoder.h"

#include <array>
#include <string>

#include "core/base/bits.h"
#include "core/pm/split_model.h"

namespace pmesh {
namespace {

class SplitDecoder {
 public:
  SplitDecoder(ByteView chunk, const FileHeader& header)
      : bits_(chunk),
        header_(header),
        added_(make_point_model(header.lattice.bits)),
        kept_(make_point_model(header.lattice.bits)) {}

  Result<VertexSplit> next(const RefinableMesh& mesh) {
    const Result<SplitSite> site = get_site(3 * mesh.face_count());
    if (!site) return site.error();
    VertexSplit split{*site, {}};
    const Vec3i kept = mesh.positions()[kept_vertex(mesh.connectivity(), *site).value];
    if (Status placed = get_positions(kept, split); !placed) return placed.error();
    if (bits_.failed()) return bad_input("the chunk ends inside a split");
    return split;
  }

  bool at_end() const { return bits_.at_end(); }

 private:
  Result<SplitSite> get_site(std::uint32_t half_edges) {
    SplitSite site;
    site.kind = get_kind();
    site.half_edge = HalfEdgeId(bits_.get(bits_for(half_edges)));
    if (site.half_edge.value >= half_edges) return bad_input("the half-edge does not exist");
    const std::uint32_t moved = get_exp_golomb() + (site.kind == SplitKind::interior ? 1u : 0u);
    if (moved > kMaxMovedFaces) return bad_input("more than 255 moved faces");
    site.moved_faces = static_cast<std::uint16_t>(moved);
    if (bits_.failed()) return bad_input("the chunk ends inside a split");
    return site;
  }

  Status get_positions(Vec3i kept, VertexSplit& split) {
    const Result<Vec3i> added = get_point(kept, added_);
    if (!added) return prefixed("added vertex", added.error());
    split.position = *added;
    if (!header_.has_relocations) return {};
    const Result<Vec3i> moved = get_point(predicted_kept(kept, *added), kept_);
    if (!moved) return prefixed("kept vertex", moved.error());
    split.relocation = *moved - kept;
    return {};
  }

  Result<Vec3i> get_point(Vec3i predicted, PointModel& model) {
    std::array<std::int32_t, 3> at = {predicted.x, predicted.y, predicted.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int64_t residual = unzigzag(get_rice(model[axis]));
      const std::int64_t coordinate = at[axis] + residual;
      if (coordinate < 0 || coordinate >> header_.lattice.bits != 0) {
        return bad_input("off the lattice");
      }
      at[axis] = static_cast<std::int32_t>(coordinate);
    }
    return Vec3i{at[0], at[1], at[2]};
  }

  SplitKind get_kind() {
    if (!header_.has_borders || bits_.get(1) == 0) return SplitKind::interior;
    return bits_.get(1) == 0 ? SplitKind::border_first : SplitKind::border_last;
  }

  std::uint32_t get_exp_golomb() {
    int width = kMovedFacesOrder;
    while (bits_.get(1) == 1 && width < 16) ++width;
    return (1u << width) - (1u << kMovedFacesOrder) + bits_.get(width);
  }

  std::uint32_t get_rice(RiceModel& model) {
    std::uint32_t quotient = 0;
    while (quotient < kRiceEscape && bits_.get(1) == 1) ++quotient;
    const int parameter = model.parameter();
    const std::uint32_t value =
        quotient == kRiceEscape ? bits_.get(32) : (quotient << parameter) + bits_.get(parameter);
    model.update(value);
    return value;
  }

  BitReader bits_;
  const FileHeader& header_;
  PointModel added_, kept_;
};

}  // namespace

Status decode_chunk(ByteView chunk, std::uint32_t split_count, const FileHeader& header,
                    RefinableMesh& mesh) {
  SplitDecoder decoder(chunk, header);
  for (std::uint32_t k = 0; k < split_count; ++k) {
    const Result<VertexSplit> split = decoder.next(mesh);
    const Status applied = split ? mesh.append(*split) : Status(split.error());
    if (!applied) return prefixed("split " + std::to_string(k), applied.error());
  }
  if (!decoder.at_end()) return bad_input("bytes are left over after the last split");
  return {};
}

}  // namespace pmesh
