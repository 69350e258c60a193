// pmesh info: what a PM file's header and index say.
#include <cmath>
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "cli/exit_codes.h"
#include "cli/json.h"
#include "cli/verb.h"
#include "core/pm/pm_file.h"
#include "core/pm/section_meter.h"

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

// Bytes by section, and bits a vertex of the finest mesh that the file holds.
void add_sections(const PmFile& file, const SectionSizes& sizes, Json& json) {
  const FileIndex& index = file.index();
  const auto vertices = static_cast<double>(index.vertices_after(file.whole_chunks()));
  Json& sections = json["sections"];
  const auto add = [&](const char* name, double bytes) {
    sections[name] = {{"bytes", std::llround(bytes)}, {"bits_per_vertex", 8 * bytes / vertices}};
  };
  const auto of_splits = [&](SplitSection section) {
    return sizes.split_bits[static_cast<std::size_t>(section)] / 8;
  };
  add("header", static_cast<double>(sizes.header_bytes));
  add("index", static_cast<double>(sizes.index_bytes));
  add("base", static_cast<double>(sizes.base_bytes));
  add("components", static_cast<double>(sizes.component_bytes));
  add("batches", of_splits(SplitSection::batches));
  add("marks", of_splits(SplitSection::marks));
  add("cuts", of_splits(SplitSection::cuts));
  add("positions", of_splits(SplitSection::positions));
  add("relocations", of_splits(SplitSection::relocations));
  json["bits_per_vertex"] =
      8 * static_cast<double>(index.prefix_bytes(file.whole_chunks())) / vertices;
}

Json to_json(const PmFile& file, const SectionSizes& sizes) {
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
  add_sections(file, sizes, json);
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

int print_text(const PmFile& file) {
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
  return kExitOk;
}

// Decodes the file, to tell what its sections take.
int print_measured(const PmFile& file) {
  const FileIndex& index = file.index();
  const Result<Bytes> bytes = file.read(0, index.prefix_bytes(file.whole_chunks()));
  if (!bytes) return report("info", bytes.error());
  const Result<SectionSizes> sizes = measure_sections(*bytes, index);
  if (!sizes) return report("info", prefixed(file.file().path(), sizes.error()));
  print_json(to_json(file, *sizes));
  return kExitOk;
}

int run_info(const InfoOptions& options) {
  const Result<PmFile> file = PmFile::open(options.file);
  if (!file) return report("info", file.error());
  return options.json ? print_measured(*file) : print_text(*file);
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
