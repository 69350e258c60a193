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
/// the others in the order in which they are split off. Chunks grow from 4 KiB by half to 256 KiB;
/// that bound doubles until the index fits the prologue. The header's box is that of the full mesh;
/// coarser ones may exceed it where the log relocates. Fails if Draco does, or (out_of_resources)
/// if the mesh exceeds the default DecodeLimits. Deterministic.
Result<Bytes> encode(const EncodeInput& input);

}  // namespace pmesh
