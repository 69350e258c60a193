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
        differences_{RiceModel(header.lattice.bits), RiceModel(header.lattice.bits),
                     RiceModel(header.lattice.bits)} {}

  Result<VertexSplit> next(const RefinableMesh& mesh) {
    VertexSplit split;
    split.site.kind = get_kind();
    const std::uint32_t half_edges = 3 * mesh.face_count();
    split.site.half_edge = HalfEdgeId(bits_.get(bits_for(half_edges)));
    if (split.site.half_edge.value >= half_edges) {
      return bad_input("the half-edge does not exist");
    }
    const std::uint32_t moved =
        get_exp_golomb() + (split.site.kind == SplitKind::interior ? 1u : 0u);
    if (moved > kMaxMovedFaces) return bad_input("more than 255 moved faces");
    split.site.moved_faces = static_cast<std::uint16_t>(moved);
    if (bits_.failed()) return bad_input("the chunk ends inside a split");

    const VertexId parent = kept_vertex(mesh.connectivity(), split.site);
    const Result<Vec3i> position = get_position(mesh.positions()[parent.value]);
    if (!position) return position.error();
    split.position = *position;
    return split;
  }

  bool at_end() const { return bits_.at_end(); }

 private:
  Result<Vec3i> get_position(Vec3i parent) {
    std::array<std::int32_t, 3> at = {parent.x, parent.y, parent.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int64_t difference = unzigzag(get_rice(differences_[axis]));
      const std::int64_t coordinate = at[axis] + difference;
      if (coordinate < 0 || coordinate >> header_.lattice.bits != 0) {
        return bad_input("the new vertex lies off the lattice");
      }
      at[axis] = static_cast<std::int32_t>(coordinate);
    }
    if (bits_.failed()) return bad_input("the chunk ends inside a split");
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
  std::array<RiceModel, 3> differences_;
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
