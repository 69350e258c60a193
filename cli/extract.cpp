// pmesh extract: one level of detail of a PM file as a mesh file.
#include <algorithm>
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "cli/check_distinct.h"
#include "cli/exit_codes.h"
#include "cli/verb.h"
#include "cli/wish_options.h"
#include "client/verified_prefix.h"
#include "core/io/export.h"
#include "core/pm/pm_file.h"
#include "protocol/apply_wish.h"
#include "protocol/lod_request.h"

namespace pmesh::cli {
namespace {

struct ExtractOptions {
  std::string file;
  std::string output;
  WishOptions wish;
};

int run_extract(const ExtractOptions& options) {
  if (!export_format_of(options.output)) {
    return report("extract", {ErrorCode::usage,
                              options.output + ": expected " + std::string(kExportExtensions)});
  }
  if (Status distinct = check_distinct(options.file, options.output); !distinct) {
    return report("extract", distinct.error());
  }
  const Result<PmFile> file = PmFile::open(options.file);
  if (!file) return report("extract", file.error());
  const LodRequest wish = options.wish.wish();
  const Result<Resolution> resolved = resolve(wish, file->index());
  if (!resolved) return report("extract", prefixed(options.file, resolved.error()));
  const std::size_t chunks = std::min<std::size_t>(resolved->chunk_count, file->whole_chunks());
  Result<RefinableMesh> mesh = file->decode(chunks);
  if (!mesh) return report("extract", mesh.error());
  const Result<AppliedWish> applied = apply_wish(wish, file->index(), *mesh);
  if (!applied) return report("extract", applied.error());
  const Status written =
      export_mesh(options.output, mesh->snapshot(), file->index().header.lattice);
  if (!written) return report("extract", written.error());
  if (!applied->reached) {
    std::fprintf(stderr, "pmesh extract: the wish is out of reach: wrote %u faces, %u vertices\n",
                 applied->faces, applied->vertices);
  }
  return kExitOk;
}

}  // namespace

void add_extract(CLI::App& app, int& exit_status) {
  auto options = std::make_shared<ExtractOptions>();
  CLI::App* verb = app.add_subcommand("extract", "Write one level of detail of a PM file");
  verb->add_option("FILE", options->file, "PM file, whole or partial")->required();
  options->wish.add_to(*verb);
  verb->add_option("-o,--output", options->output, "Mesh file to write: .ply, .obj, .glb or .drc")
      ->required();
  verb->callback([options, &exit_status] { exit_status = run_extract(*options); });
}

}  // namespace pmesh::cli
