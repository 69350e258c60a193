// The offline job: mesh file in, PM file out.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/decimate/decimate.h"
#include "core/files/atomic_file.h"
#include "core/io/clean.h"
#include "core/mesh/lattice.h"
#include "core/metrics/table.h"
#include "core/precompute/quantise.h"

namespace pmesh {

struct PrecomputeOptions {
  std::string input;   ///< PLY, OBJ, STL or OFF, by extension.
  std::string output;  ///< Its name must end in .pmesh, which servers and clients go by.
  std::string metric{metric_table().front().name};
  std::string metric_parameters;  ///< As make_metric() takes them: "lambda=10".
  Precision precision;
  Schedule schedule = Schedule::batched;
  std::uint32_t base_faces = 200;  ///< Decimation stops here, or where topology ends it.
  /// Whether the index gets the measured error of each chunk end.
  bool measure = true;
  unsigned threads = 1;  ///< The output does not depend on it.
  Overwrite overwrite = Overwrite::no;
};

enum class PrecomputePhase : std::uint8_t { import, clean, decimate, encode, measure, write, done };

struct PrecomputeReport {
  std::string metric_parameters;  ///< All of them, also those left at their defaults.
  std::uint64_t input_faces = 0;  ///< Triangles in the file, polygons cut into fans.
  std::uint64_t input_vertices = 0;
  std::uint64_t polygons = 0;  ///< Faces that had more than three corners.
  CleanReport cleaned;
  std::uint64_t faces = 0;  ///< After cleaning: the full mesh.
  std::uint64_t vertices = 0;
  std::uint64_t base_faces = 0;
  std::uint64_t base_vertices = 0;
  std::uint64_t base_bytes = 0;
  /// Faces left when the metric's planar test was given up to go on; nothing if it never was.
  std::optional<std::uint64_t> planarity_relaxed_at;
  /// Faces left when the fold-over check was relaxed to go on; nothing if it never was.
  std::optional<std::uint64_t> fold_over_relaxed_at;
  /// Faces of the vertex that has most of them. With more than kMostFacesToMeasure
  /// (core/precompute/error_index.h) the errors are not measured, whatever was asked.
  std::uint32_t largest_valence = 0;
  bool measured = false;  ///< The index has the error of each chunk end.
  Lattice lattice;
  std::size_t chunks = 0;
  std::uint64_t file_bytes = 0;
  std::string hash;
};

/// Called at the start of each phase (and at `done`) and, in the long ones, now and then with how
/// far it is, 0 to 1. Called on the caller's thread.
using PrecomputeProgress = std::function<void(PrecomputePhase phase, double fraction)>;

/// Imports, cleans, decimates, encodes and writes. On any error the output is as it was before:
/// absent, or the old file. Errors: usage (unknown metric, the output's name), bad_input (the mesh,
/// with file and place), runtime and out_of_resources (files). Same input and options, same bytes.
Result<PrecomputeReport> precompute(const PrecomputeOptions& options,
                                    const PrecomputeProgress& progress);

}  // namespace pmesh
