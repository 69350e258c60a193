#include "core/pm/encoder.h"

#include <algorithm>
#include <cassert>

#include "core/base/box.h"
#include "core/base/crc32c.h"
#include "core/pm/base_codec.h"
#include "core/pm/digest.h"
#include "core/pm/format.h"
#include "core/pm/split_encoder.h"
#include "core/refine/refinable_mesh.h"

namespace pmesh {
namespace {

constexpr std::size_t kFirstChunkBytes = 4 * 1024;
constexpr std::size_t kLargestChunkBytes = 256 * 1024;

// Replays the log backwards on the base and cuts the splits into chunks.
class ChunkWriter {
 public:
  ChunkWriter(const EncodeInput& input, const FileHeader& header, const LatticeMesh& base,
              std::vector<VertexId> file_ids)
      : input_(input),
        header_(header),
        mesh_(RefinableMesh::from_base(base).value()),
        file_ids_(std::move(file_ids)) {
    mesh_.reserve(static_cast<std::uint32_t>(header.vertices),
                  static_cast<std::uint32_t>(header.faces));
  }

  /// Appends chunks to `body` and their rows to `rows`; false as soon as there are more than
  /// `most_rows`.
  bool write(std::size_t largest, std::size_t most_rows, std::vector<ChunkRow>& rows, Bytes& body) {
    const std::size_t step = input_.log.collapses_per_step;
    const std::size_t step_bytes = step * header_.max_split_bytes();
    std::size_t target = kFirstChunkBytes;
    for (std::size_t left = input_.log.collapses.size(); left > 0;) {
      if (rows.size() == most_rows) return false;
      SplitEncoder chunk(header_);
      while (left > 0 && chunk.byte_count() + step_bytes <= target) {
        for (std::size_t k = 0; k < step; ++k) put_split(--left, chunk);
      }
      rows.push_back(finish(std::move(chunk), body));
      target = std::min(target + target / 2, largest);
    }
    return true;
  }

  /// Where the vertices of the finest LOD written lie.
  std::span<const Vec3i> positions() const { return mesh_.positions(); }

 private:
  VertexId file_id(VertexId original) const {
    return original.valid() ? file_ids_[original.value] : original;
  }

  Vec3i relocation(std::size_t index) const {
    if (!header_.has_relocations) return {};
    const VertexId kept = file_id(input_.log.collapses[index].kept);
    return input_.lattice.quantise(input_.log.kept_before[index]) - mesh_.positions()[kept.value];
  }

  void put_split(std::size_t index, SplitEncoder& chunk) {
    const HalfEdgeCollapse& collapse = input_.log.collapses[index];
    const HalfEdgeCollapse renamed{VertexId(mesh_.vertex_count()), file_id(collapse.kept),
                                   file_id(collapse.left), file_id(collapse.right)};
    const VertexSplit split{mesh_.connectivity().find_site(renamed),
                            input_.positions[collapse.removed.value], relocation(index)};
    chunk.put(split, mesh_);
    [[maybe_unused]] const Status applied = mesh_.append(split);
    assert(applied.ok());
    file_ids_[collapse.removed.value] = renamed.removed;
  }

  ChunkRow finish(SplitEncoder chunk, Bytes& body) const {
    const Bytes bytes = std::move(chunk).finish();
    ChunkRow row;
    row.bytes = static_cast<std::uint32_t>(bytes.size());
    row.crc = crc32c(bytes);
    row.digest = digest_section(bytes);
    row.vertices = mesh_.vertex_count();
    row.faces = mesh_.face_count();
    body.insert(body.end(), bytes.begin(), bytes.end());
    return row;
  }

  const EncodeInput& input_;
  const FileHeader& header_;
  RefinableMesh mesh_;
  std::vector<VertexId> file_ids_;  // by original vertex, once it stands
};

FileHeader describe(const EncodeInput& input, const EncodedBase& base) {
  FileHeader header;
  header.lattice = input.lattice;
  header.metric = input.metric;
  header.parameters = input.parameters;
  header.unit = input.unit;
  header.base_vertices = base.decoded.positions.size();
  header.base_faces = base.decoded.triangles.size();
  header.base_bytes = base.bytes.size();
  header.base_crc = crc32c(base.bytes);
  header.base_digest = digest_section(base.bytes);
  header.vertices = header.base_vertices + input.log.collapses.size();
  header.faces = header.base_faces;
  for (const HalfEdgeCollapse& collapse : input.log.collapses) {
    header.faces += static_cast<std::uint64_t>(collapse.removed_faces());
    header.has_borders |= collapse.removed_faces() == 1;
  }
  header.has_relocations = !input.log.kept_before.empty();
  return header;
}

std::size_t most_rows(const FileIndex& index) {
  FileIndex one_row = index;
  one_row.chunks.resize(1);
  const std::size_t header = prologue_size(index);
  return (kMaxPrologueBytes - header) / (prologue_size(one_row) - header);
}

// Base and chunks; fills in the index's rows, and its box from the mesh that they end in.
Bytes write_body(const EncodeInput& input, const EncodedBase& base,
                 const std::vector<VertexId>& file_ids, FileIndex& index) {
  const std::size_t rows_that_fit = most_rows(index);
  for (std::size_t largest = kLargestChunkBytes;; largest *= 2) {
    Bytes body = base.bytes;
    index.chunks.clear();
    ChunkWriter writer(input, index.header, base.decoded, file_ids);
    if (!writer.write(largest, rows_that_fit, index.chunks, body)) continue;
    const Box<std::int32_t> box = bounding_box(writer.positions());
    index.header.box_low = box.low;
    index.header.box_high = box.high;
    return body;
  }
}

}  // namespace

Result<Bytes> encode(const EncodeInput& input) {
  [[maybe_unused]] const CollapseLog& log = input.log;
  assert(log.kept_before.empty() || log.kept_before.size() == log.collapses.size());
  assert(log.collapses.size() % log.collapses_per_step == 0);
  LiveMesh live = input.base.live();
  LatticeMesh mesh;
  for (const VertexId v : live.vertices) mesh.positions.push_back(input.positions[v.value]);
  mesh.triangles = std::move(live.triangles);
  Result<EncodedBase> base = encode_base(mesh);
  if (!base) return prefixed("base mesh", base.error());
  std::vector<VertexId> file_ids(input.base.vertex_slots());
  for (std::size_t v = 0; v < live.vertices.size(); ++v) {
    file_ids[live.vertices[v].value] = VertexId(base->decoded_vertex[v]);
  }

  FileIndex index;
  index.header = describe(input, *base);
  const Bytes body = write_body(input, *base, file_ids, index);

  Bytes file = write_hashed_prologue(index);
  // The default limits of a reader are the writer's, too.
  if (const auto readable = parse_prologue(file); !readable) return readable.error();
  file.insert(file.end(), body.begin(), body.end());
  return file;
}

}  // namespace pmesh
