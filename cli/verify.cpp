// pmesh verify: replays a PM file, checks its claims, and compares it with its source if asked.
#include "core/pm/verify.h"

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "cli/exit_codes.h"
#include "cli/verb.h"
#include "core/io/clean.h"
#include "core/io/import.h"
#include "core/precompute/quantise.h"

namespace pmesh::cli {
namespace {

struct VerifyOptions {
  std::string file;
  std::string source;
};

// Whether the full mesh has exactly the triangles of the mesh file `source`, cleaned and quantised.
Status compare_with_source(const VerifiedFile& file, const std::string& source) {
  Result<ImportedMesh> imported = import_mesh(source);
  if (!imported) return imported.error();
  CleanedMesh cleaned = clean(std::move(*imported));
  const LatticeMesh expected{quantise(cleaned.mesh.positions, file.index.header.lattice),
                             std::move(cleaned.mesh.triangles)};
  if (!same_triangles(expected, file.full)) {
    return Error{ErrorCode::verification, "the full mesh does not have the triangles of " + source};
  }
  return {};
}

int run_verify(const VerifyOptions& options) {
  const Result<VerifiedFile> file = verify_file(options.file);
  if (!file) return report("verify", file.error());
  if (!options.source.empty()) {
    if (Status same = compare_with_source(*file, options.source); !same) {
      return report("verify", same.error());
    }
  }
  const FileHeader& header = file->index.header;
  std::printf("%s: ok: %llu faces, %llu vertices, %zu chunks, hash %s%s%s\n", options.file.c_str(),
              static_cast<unsigned long long>(header.faces),
              static_cast<unsigned long long>(header.vertices), file->index.chunks.size(),
              to_hex(header.content_hash).c_str(),
              options.source.empty() ? "" : ", same triangles as ", options.source.c_str());
  return kExitOk;
}

}  // namespace

void add_verify(CLI::App& app, int& exit_status) {
  auto options = std::make_shared<VerifyOptions>();
  CLI::App* verb = app.add_subcommand("verify", "Replay a PM file and check its claims");
  verb->add_option("FILE", options->file, "PM file")->required();
  verb->add_option(
      "--source", options->source,
      "The mesh it was made from: must have the same triangles, cleaned and quantised");
  verb->callback([options, &exit_status] { exit_status = run_verify(*options); });
}

}  // namespace pmesh::cli
