// From a base mesh and a collapse log to a PM file's bytes.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/decimate/collapse_log.h"
#include "core/mesh/indexed_mesh.h"
#include "core/mesh/lattice.h"

namespace pmesh {

/// What decimation left, all of it in the decimated mesh's vertex ids.
struct EncodeInput {
  const HalfEdgeMesh& base;  ///< After the last collapse of `log`.
  /// By vertex, on the lattice: where it lies in the base or, if removed, where it lay then.
  std::span<const Vec3i> positions;
  const CollapseLog& log;
  Lattice lattice;     ///< Over all positions that a vertex ever has.
  std::string metric;  ///< Name and parameters, for the header; at most 64 bytes together.
  std::string parameters;
  std::string unit;  ///< At most 16 bytes; may be empty.
};

/// The whole file. Renames vertices: the base's come first, in the order Draco gives them, then
/// the others in the order in which they arrive or are split off. In the first 4 KiB a
/// chunk has about half the bytes before it, but at least 800, then as many as there are before it,
/// and at most a tenth of all, or 8 KiB if that is more, but never over 256 KiB; the last bound
/// doubles until the index fits the prologue, and, beside it, a base of up to 8 KiB the first
/// 16 KiB. The header's box is that of the full mesh; coarser
/// ones may exceed it where the log relocates.
///
/// Of several components the base holds the largest, and with it as many of the next, by the
/// diagonals of their bounding boxes, as keep it at 2,000 faces and 8 KiB. The others begin chunks,
/// of which they take about half, ahead of their first splits: small before, each chunk has one new
/// component at least as long as any are left.
///
/// Fails if Draco does, or (out_of_resources) if the mesh exceeds the default DecodeLimits.
/// Deterministic.
Result<Bytes> encode(const EncodeInput& input);

}  // namespace pmesh
