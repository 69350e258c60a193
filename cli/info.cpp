// pmesh info: what a PM file's header and index say.
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "cli/exit_codes.h"
#include "cli/json.h"
#include "cli/verb.h"
#include "core/pm/pm_file.h"

namespace pmesh::cli {
namespace {

struct InfoOptions {
  std::string file;
  bool json = false;
};

Json to_json(Vec3d v) { return Json::array({v.x, v.y, v.z}); }

Json error_or_null(const FileHeader& header, double error) {
  return header.errors_measured ? Json(error) : Json(nullptr);
}

Json to_json(const PmFile& file) {
  const FileHeader& h = file.index().header;
  Json json = {
      {"vertices", h.vertices},
      {"faces", h.faces},
      {"base_vertices", h.base_vertices},
      {"base_faces", h.base_faces},
      {"base_bytes", h.base_bytes},
      {"quantization", h.lattice.bits},
      {"step", h.lattice.step},
      {"origin", to_json(h.lattice.origin)},
      {"bbox",
       {{"min", to_json(h.lattice.position(h.box_low))},
        {"max", to_json(h.lattice.position(h.box_high))}}},
      {"bbox_diagonal", h.box_diagonal()},
      {"unit", h.unit},
      {"metric", h.metric},
      {"parameters", h.parameters},
      {"borders", h.has_borders},
      {"errors_measured", h.errors_measured},
      {"hash", to_hex(h.content_hash)},
      {"file_bytes", h.file_bytes},
      {"bytes_on_disk", file.bytes_on_disk()},
      {"complete", file.complete()},
      {"whole_chunks", file.whole_chunks()},
      {"prologue_bytes", file.index().prologue_bytes},
  };
  Json& chunks = json["chunks"] = Json::array();
  for (const ChunkRow& row : file.index().chunks) {
    chunks.push_back({{"offset", row.offset},
                      {"bytes", row.bytes},
                      {"faces", row.faces},
                      {"vertices", row.vertices},
                      {"max_error", error_or_null(h, row.max_error)},
                      {"rms_error", error_or_null(h, row.rms_error)}});
  }
  return json;
}

unsigned long long number(std::uint64_t n) { return n; }

void print_chunks(const FileIndex& index) {
  const bool has_errors = index.header.errors_measured;
  std::printf("%6s %12s %10s %12s %12s", "chunk", "offset", "bytes", "faces", "vertices");
  if (has_errors) std::printf(" %12s %12s", "max_error", "rms_error");
  std::printf("\n");
  for (std::size_t c = 0; c < index.chunks.size(); ++c) {
    const ChunkRow& row = index.chunks[c];
    std::printf("%6zu %12llu %10u %12llu %12llu", c, number(row.offset), row.bytes,
                number(row.faces), number(row.vertices));
    if (has_errors) std::printf(" %12.6g %12.6g", row.max_error, row.rms_error);
    std::printf("\n");
  }
}

void print_text(const PmFile& file) {
  const FileIndex& index = file.index();
  const FileHeader& h = index.header;
  std::printf("hash          %s\n", to_hex(h.content_hash).c_str());
  std::printf("file          %llu bytes%s\n", number(h.file_bytes),
              file.complete() ? "" : " (partial)");
  if (!file.complete()) {
    std::printf("on disk       %llu bytes: base and %zu of %zu chunks\n",
                number(file.bytes_on_disk()), file.whole_chunks(), index.chunks.size());
  }
  std::printf("full mesh     %llu faces, %llu vertices%s\n", number(h.faces), number(h.vertices),
              h.has_borders ? ", with borders" : "");
  std::printf("base          %llu faces, %llu vertices, %llu bytes\n", number(h.base_faces),
              number(h.base_vertices), number(h.base_bytes));
  std::printf("quantization  %d bits, step %.6g%s%s\n", h.lattice.bits, h.lattice.step,
              h.unit.empty() ? "" : " ", h.unit.c_str());
  std::printf("bbox diagonal %.6g%s%s\n", h.box_diagonal(), h.unit.empty() ? "" : " ",
              h.unit.c_str());
  std::printf("metric        %s %s\n", h.metric.c_str(), h.parameters.c_str());
  if (!h.errors_measured) std::printf("errors not measured\n");
  print_chunks(index);
}

int run_info(const InfoOptions& options) {
  const Result<PmFile> file = PmFile::open(options.file);
  if (!file) return report("info", file.error());
  if (options.json) {
    print_json(to_json(*file));
  } else {
    print_text(*file);
  }
  return kExitOk;
}

}  // namespace

void add_info(CLI::App& app, int& exit_status) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* verb = app.add_subcommand("info", "Show what a PM file holds");
  verb->add_option("FILE", options->file, "PM file, whole or partial")->required();
  verb->add_flag("--json", options->json, "Print one JSON object");
  verb->callback([options, &exit_status] { exit_status = run_info(*options); });
}

}  // namespace pmesh::cli
