#include "core/precompute/precompute.h"

#include <utility>

#include "core/decimate/decimate.h"
#include "core/files/out_of_memory.h"
#include "core/io/import.h"
#include "core/mesh/half_edge_mesh.h"
#include "core/metrics/table.h"
#include "core/pm/encoder.h"
#include "core/pm/format.h"
#include "core/precompute/error_index.h"
#include "core/precompute/quantise.h"
#include "core/precompute/sort_spatially.h"

namespace pmesh {
namespace {

// Fails now, not after the work, if the output could not be written.
Status probe_output(const PrecomputeOptions& options) {
  if (!options.output.ends_with(".pmesh")) {
    return Error{ErrorCode::usage, options.output + ": expected a name in .pmesh"};
  }
  const Result<AtomicFile> probe = AtomicFile::create(options.output, options.overwrite);
  return probe ? Status() : Status(probe.error());
}

Result<IndexedMesh> import_and_clean(const PrecomputeOptions& options,
                                     const PrecomputeProgress& progress, PrecomputeReport& report) {
  progress(PrecomputePhase::import, 0);
  Result<ImportedMesh> imported = import_mesh(options.input);
  if (!imported) return imported.error();
  report.input_faces = imported->mesh.triangles.size();
  report.input_vertices = imported->mesh.positions.size();
  report.polygons = imported->polygons;

  progress(PrecomputePhase::clean, 0);
  CleanedMesh cleaned = clean(std::move(*imported));
  if (cleaned.mesh.triangles.empty()) {
    return bad_input(options.input + ": no face with three distinct vertices");
  }
  report.cleaned = cleaned.report;
  report.faces = cleaned.mesh.triangles.size();
  report.vertices = cleaned.mesh.positions.size();
  sort_spatially(cleaned.mesh, options.threads);
  return std::move(cleaned.mesh);
}

Result<Decimation> decimate_mesh(const IndexedMesh& mesh, const AnyMetric& metric,
                                 const PrecomputeOptions& options,
                                 const PrecomputeProgress& progress, PrecomputeReport& report) {
  progress(PrecomputePhase::decimate, 0);
  Result<HalfEdgeMesh> connectivity =
      HalfEdgeMesh::build(mesh.triangles, static_cast<std::uint32_t>(mesh.positions.size()));
  if (!connectivity) return prefixed("after cleaning", connectivity.error());
  DecimateOptions decimation;
  decimation.metric = metric;
  decimation.schedule = options.schedule;
  decimation.base_faces = options.base_faces;
  decimation.threads = options.threads;
  decimation.progress = [&](std::uint64_t done, std::uint64_t total) {
    progress(PrecomputePhase::decimate, static_cast<double>(done) / static_cast<double>(total));
  };
  Decimation result = decimate(std::move(*connectivity), mesh.positions, decimation);
  report.planarity_relaxed_at = result.report.planarity_relaxed_at_faces;
  report.fold_over_relaxed_at = result.report.fold_over_relaxed_at_faces;
  return result;
}

// Over every position that a vertex has at any level: placed vertices may leave the mesh's box.
Result<Lattice> lattice_over_all(const IndexedMesh& mesh, const Decimation& decimation,
                                 const Precision& precision) {
  std::vector<Vec3d> reach = mesh.positions;
  reach.insert(reach.end(), decimation.positions.begin(), decimation.positions.end());
  const std::vector<Vec3d>& before = decimation.log.kept_before;
  reach.insert(reach.end(), before.begin(), before.end());
  return choose_lattice(mesh, reach, precision);
}

// What the header says of the file just encoded.
void report_file(const Bytes& file, PrecomputeReport& report) {
  const auto index = parse_prologue(file);
  report.chunks = (*index)->chunks.size();
  report.base_faces = (*index)->header.base_faces;
  report.base_vertices = (*index)->header.base_vertices;
  report.base_bytes = (*index)->header.base_bytes;
  report.file_bytes = file.size();
  report.hash = to_hex((*index)->header.content_hash);
}

Result<PrecomputeReport> run(const PrecomputeOptions& options, const PrecomputeProgress& progress) {
  PrecomputeReport report;
  const Result<AnyMetric> metric = make_metric(options.metric, options.metric_parameters);
  if (!metric) return metric.error();
  report.metric_parameters = metric_parameters(*metric);
  if (Status probed = probe_output(options); !probed) return probed.error();
  Result<IndexedMesh> mesh = import_and_clean(options, progress, report);
  if (!mesh) return mesh.error();
  if (const Result<Lattice> possible = choose_lattice(*mesh, mesh->positions, options.precision);
      !possible) {  // known before the long work
    return prefixed(options.input, possible.error());
  }

  const Result<Decimation> decimation = decimate_mesh(*mesh, *metric, options, progress, report);
  if (!decimation) return decimation.error();
  const Result<Lattice> lattice = lattice_over_all(*mesh, *decimation, options.precision);
  if (!lattice) return prefixed(options.input, lattice.error());
  report.lattice = *lattice;

  progress(PrecomputePhase::encode, 0);
  const std::vector<Vec3i> points = quantise(decimation->positions, *lattice);
  Result<Bytes> file = encode({decimation->mesh, points, decimation->log, *lattice, options.metric,
                               report.metric_parameters, ""});
  if (!file) return prefixed(options.output, file.error());
  report.largest_valence = largest_valence(*mesh);
  report.measured = options.measure && report.largest_valence <= kMostFacesToMeasure;
  if (report.measured) {
    const Status measured = write_error_index(*file, *mesh, options.threads, [&](double fraction) {
      progress(PrecomputePhase::measure, fraction);
    });
    if (!measured) return prefixed(options.input, measured.error());
  }
  report_file(*file, report);

  progress(PrecomputePhase::write, 0);
  if (Status written = write_file(options.output, *file, options.overwrite); !written)
    return written.error();
  progress(PrecomputePhase::done, 1);
  return report;
}

}  // namespace

Result<PrecomputeReport> precompute(const PrecomputeOptions& options,
                                    const PrecomputeProgress& progress) {
  return catching_out_of_memory([&] { return run(options, progress); });
}

}  // namespace pmesh
