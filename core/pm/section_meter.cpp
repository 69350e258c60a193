#include "core/pm/section_meter.h"

#include <cassert>
#include <cmath>

#include "core/pm/base_codec.h"
#include "core/pm/chunk_reader.h"
#include "core/pm/mesh_section.h"
#include "core/pm/split_coder.h"

namespace pmesh {
namespace {

// A reader that keeps count.
class MeteredReader {
 public:
  static constexpr bool kDecodes = true;

  MeteredReader(ByteView chunk, std::array<double, kSplitSections>& bits)
      : reader_(chunk), bits_(bits) {}

  void enter(SplitSection section) { section_ = static_cast<std::size_t>(section); }
  bool bit(AdaptiveBit& model, bool /*ignored*/ = false) {
    const double one = static_cast<double>(model.one()) / 65536;
    const bool decoded = reader_.bit(model);
    bits_[section_] -= std::log2(decoded ? one : 1 - one);
    return decoded;
  }
  std::uint32_t raw(int count, std::uint32_t /*ignored*/ = 0) {
    bits_[section_] += count;
    return reader_.raw(count);
  }
  bool failed() const { return reader_.failed(); }

 private:
  ChunkReader reader_;
  std::array<double, kSplitSections>& bits_;
  std::size_t section_ = 0;
};

Status take_components(ByteView components, const ChunkRow& row, RefinableMesh& mesh) {
  if (row.arrivals.faces == 0) return {};
  const Result<LatticeMesh> decoded = decode_base(components, row.arrivals);
  return decoded ? mesh.append(*decoded) : decoded.error();
}

}  // namespace

Result<SectionSizes> measure_sections(ByteView file, const FileIndex& index) {
  assert(file.size() >= index.base_end());
  SectionSizes sizes;
  FileIndex without_rows = index;
  without_rows.chunks.clear();
  sizes.header_bytes = prologue_size(without_rows);
  sizes.index_bytes = index.prologue_bytes - sizes.header_bytes;
  sizes.base_bytes = index.header.base_bytes;
  const ByteView base = file.subspan(index.prologue_bytes, index.header.base_bytes);
  const Result<LatticeMesh> decoded = decode_base(base, index.header.base_counts());
  if (!decoded) return decoded.error();
  Result<RefinableMesh> mesh = RefinableMesh::from_base(*decoded);
  if (!mesh) return mesh.error();
  BatchMesh state(*mesh);
  SplitModel model;
  std::vector<BatchSplit> batch;
  for (const ChunkRow& row : index.chunks) {
    if (row.end() > file.size()) break;
    const Result<ChunkParts> parts = chunk_parts(file.subspan(row.offset, row.bytes), row);
    if (!parts) return parts.error();
    if (Status status = take_components(parts->components, row, *mesh); !status)
      return status.error();
    state.grow(*mesh);
    sizes.component_bytes += parts->components.size();
    MeteredReader reader(parts->splits, sizes.split_bits);
    SplitCoder<MeteredReader> coder(reader, index.header, model, *mesh, state);
    while (mesh->vertex_count() < row.vertices) {
      const auto left = static_cast<std::uint32_t>(row.vertices - mesh->vertex_count());
      Status status = coder.code(batch, left);
      if (status.ok()) status = state.apply(batch, *mesh);
      if (!status) return status.error();
    }
  }
  return sizes;
}

}  // namespace pmesh
