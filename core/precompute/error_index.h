// The error index: what each chunk end of a PM file is off the surface that was imported.
#pragma once

#include <cstdint>
#include <functional>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/mesh/indexed_mesh.h"

namespace pmesh {

/// The nearest of k faces that meet in one point takes time in proportion to k to find, and near a
/// hub every face asks: meshes with a vertex of more faces than this are not measured.
inline constexpr std::uint32_t kMostFacesToMeasure = 4096;

/// The faces of the vertex that has most of them.
std::uint32_t largest_valence(const IndexedMesh& mesh);

/// Decodes the whole PM file `file`, measures every chunk end against `original`, the cleaned mesh
/// before quantisation (core/measure/level_errors.h), writes the errors into the index and brings
/// the content hash up to date. Positions are measured as exports give them. `progress` is called
/// with a fraction of 0 to 1. Fails, leaving the file without errors, if the mesh cannot be
/// measured. The result does not depend on `threads`.
Status write_error_index(Bytes& file, const IndexedMesh& original, unsigned threads,
                         const std::function<void(double)>& progress);

}  // namespace pmesh
