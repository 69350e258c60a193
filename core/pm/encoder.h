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
  const HalfEdgeMesh& base;          ///< After the last collapse of `log`.
  std::span<const Vec3i> positions;  ///< Lattice positions of all vertices, removed ones too.
  const CollapseLog& log;
  Lattice lattice;
  std::string metric;  ///< Name and parameters, for the header; at most 64 bytes together.
  std::string parameters;
  std::string unit;  ///< At most 16 bytes; may be empty.
};

/// The whole file. Renames vertices: the base's come first, in the order Draco gives them, then
/// the others in the order in which they are split off. Chunks grow from 4 KiB by half to 256 KiB;
/// that bound doubles until the index fits the prologue. Fails if Draco does, or (out_of_resources)
/// if the mesh exceeds the default DecodeLimits. Deterministic.
Result<Bytes> encode(const EncodeInput& input);

}  // namespace pmesh
