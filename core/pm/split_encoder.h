// Writes vertex splits into a chunk, the inverse of core/pm/split_decoder.h.
#pragma once

#include <cstdint>

#include "core/base/bits.h"
#include "core/base/bytes.h"
#include "core/pm/format.h"
#include "core/pm/split_model.h"
#include "core/refine/refinable_mesh.h"

namespace pmesh {

/// One chunk in the making. `header` must outlive it.
class SplitEncoder {
 public:
  explicit SplitEncoder(const FileHeader& header);

  /// Appends `split`, which is about to be applied to `mesh`. Preconditions: mesh's finest LOD
  /// stands, and the split is possible there and moves at most kMaxMovedFaces faces.
  void put(const VertexSplit& split, const RefinableMesh& mesh);

  std::size_t byte_count() const { return (bits_.bit_count() + 7) / 8; }
  Bytes finish() && { return std::move(bits_).finish(); }

 private:
  void put_point(Vec3i point, Vec3i predicted, PointModel& model);
  void put_exp_golomb(std::uint32_t value);
  void put_rice(std::uint32_t value, RiceModel& model);

  BitWriter bits_;
  const FileHeader& header_;
  PointModel added_, kept_;
};

}  // namespace pmesh
