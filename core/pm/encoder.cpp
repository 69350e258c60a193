#include "core/pm/encoder.h"

#include <algorithm>
#include <cassert>

#include "core/base/box.h"
#include "core/base/crc32c.h"
#include "core/pm/base_codec.h"
#include "core/pm/batch_builder.h"
#include "core/pm/chunk_writer.h"
#include "core/pm/components.h"
#include "core/pm/digest.h"
#include "core/pm/fit_parameters.h"
#include "core/pm/format.h"
#include "core/pm/mesh_section.h"
#include "core/pm/split_coder.h"
#include "core/refine/refinable_mesh.h"

namespace pmesh {
namespace {

// The first chunks have half the bytes before them, so that the coarsest LODs lie close, the others
// as many as there are before them, but at most a tenth of all, so that little is left to decode
// when the last byte has come.
constexpr std::size_t kFirstChunkBytes = 800;
constexpr std::size_t kFirstChunksEnd = 4096;
constexpr std::size_t kLeastLargestChunkBytes = 8 * 1024;
constexpr std::size_t kLargestChunkBytes = 256 * 1024;
constexpr std::size_t kBitsOfSplit = 17;  // what a split takes, about

// What a base that leaves room for header and index in the first 16 KiB has at most, if components
// can be put off for it.
constexpr std::size_t kSmallBaseFaces = 2000;
constexpr std::size_t kSmallBaseBytes = kMaxPrologueBytes / 2;

// The first components, coded.
struct Base {
  std::size_t components = 0;
  std::vector<VertexId> originals;
  EncodedBase coded;
};

Result<Base> encode_first(const Components& components, std::size_t count) {
  Components::Part part = components.part(0, count);
  Result<EncodedBase> coded = encode_base(part.mesh);
  if (!coded) return prefixed("base mesh", coded.error());
  return Base{count, std::move(part.originals), std::move(*coded)};
}

// As many components, largest first, as keep the base small, but at least one.
Result<Base> choose_base(const Components& components) {
  std::size_t count = 1;
  while (count < components.count() && components.faces(0, count + 1) <= kSmallBaseFaces) ++count;
  while (true) {
    Result<Base> base = encode_first(components, count);
    if (!base || count == 1 || base->coded.bytes.size() <= kSmallBaseBytes) return base;
    const std::size_t that_fit = count * kSmallBaseBytes / base->coded.bytes.size();
    count = std::clamp<std::size_t>(that_fit, 1, count - 1);
  }
}

// Gathers the log's splits into batches, and new components and batches into chunks.
class BodyWriter {
 public:
  BodyWriter(const EncodeInput& input, const FileHeader& header, const Components& components,
             const Base& base)
      : header_(header),
        step_(input.log.collapses_per_step),
        components_(components),
        arrived_(base.components),
        bytes_a_vertex_(static_cast<double>(base.coded.bytes.size()) /
                        static_cast<double>(base.originals.size())),
        mesh_(RefinableMesh::from_base(base.coded.decoded).value()),
        state_(mesh_),
        builder_(input.log, input.positions, input.lattice) {
    mesh_.reserve(static_cast<std::uint32_t>(header.vertices),
                  static_cast<std::uint32_t>(header.faces));
    place(base.originals, base.coded, 0);
    builder_.add(components.collapses(0, arrived_));
  }

  /// Appends chunks to `body` and their rows to `rows`; false as soon as there are more than
  /// `most_rows`.
  Result<bool> write(std::size_t largest, std::size_t most_rows, std::vector<ChunkRow>& rows,
                     Bytes& body) {
    const std::size_t tenth = header_.vertices * kBitsOfSplit / 8 / 10;
    largest = std::min(largest, std::max(tenth, kLeastLargestChunkBytes));
    while (splits_left() || arrived_ < components_.count()) {
      if (rows.size() == most_rows) return false;
      const std::size_t before = body.size();
      const std::size_t target =
          std::clamp(before < kFirstChunksEnd ? before / 2 : before, kFirstChunkBytes, largest);
      ChunkRow row;
      Bytes bytes;
      if (arrived_ < components_.count()) {
        if (Status put = put_components(target / 2, row, bytes); !put) return put.error();
      }
      put_splits(target, bytes);
      finish(bytes, row, body);
      rows.push_back(row);
    }
    return true;
  }

  /// Where the vertices of the finest LOD written lie.
  std::span<const Vec3i> positions() const { return mesh_.positions(); }

 private:
  bool splits_left() const { return parts_left_ > 0 || builder_.left() > 0; }

  void place(std::span<const VertexId> originals, const EncodedBase& coded,
             std::uint32_t first_vertex) {
    for (std::size_t v = 0; v < originals.size(); ++v) {
      builder_.place(originals[v], VertexId(first_vertex + coded.decoded_vertex[v]));
    }
  }

  // The next components, of about `target` bytes together.
  Status put_components(std::size_t target, ChunkRow& row, Bytes& bytes) {
    const std::size_t first = arrived_++;
    while (arrived_ < components_.count() &&
           bytes_a_vertex_ * static_cast<double>(components_.vertices(first, arrived_ + 1)) <=
               static_cast<double>(target)) {
      ++arrived_;
    }
    const Components::Part part = components_.part(first, arrived_);
    const Result<EncodedBase> coded = encode_base(part.mesh);
    if (!coded) return prefixed("new components", coded.error());
    place(part.originals, *coded, mesh_.vertex_count());
    [[maybe_unused]] const Status arrived = mesh_.append(coded->decoded);
    assert(arrived.ok());
    state_.grow(mesh_);
    builder_.add(components_.collapses(first, arrived_));
    row.arrivals = {part.mesh.positions.size(), part.mesh.triangles.size()};
    bytes = write_components(coded->bytes);
    bytes_a_vertex_ =
        static_cast<double>(bytes.size()) / static_cast<double>(row.arrivals.vertices);
    return {};
  }

  // Batches that fill the chunk up to about `target` bytes.
  void put_splits(std::size_t target, Bytes& bytes) {
    if (!splits_left()) return;
    ChunkWriter chunk;
    const std::uint32_t before = mesh_.vertex_count();
    do {
      put_part(chunk, target * 8 / kBitsOfSplit);
    } while (splits_left() && !is_full(bytes.size() + chunk.byte_count(), before, target));
    const std::uint32_t splits = mesh_.vertex_count() - before;
    const Bytes coded = std::move(chunk).finish(splits / 8 + 1);
    bytes.insert(bytes.end(), coded.begin(), coded.end());
  }

  // Whether the next part would overshoot the target more than its lack falls short of it. Never in
  // the middle of a step.
  bool is_full(std::size_t bytes, std::uint32_t before, std::size_t target) const {
    if ((mesh_.vertex_count() - before) % step_ != 0) return false;
    const std::size_t ahead =
        parts_left_ > 0 ? (batch_.size() - coded_) / parts_left_ : builder_.batch_size_ahead();
    return bytes + ahead * kBitsOfSplit / 8 / 2 > target;
  }

  // The next part of a batch: all of it, if it has no more than `most` splits.
  void put_part(ChunkWriter& chunk, std::size_t most) {
    BatchOrder order = BatchOrder::rest_of_sweep;
    if (parts_left_ == 0) {
      batch_ = builder_.next(mesh_, state_);
      parts_left_ = count_parts(batch_.size(), most);
      coded_ = 0;
      order = state_.order_of(batch_.size());
      parameters_ = {fit_predictor(mesh_, batch_, model_.parameters.predictor),
                     fit_fan_weights(mesh_, batch_, model_.parameters.fan)};
    }
    const auto begin = batch_.begin() + static_cast<std::ptrdiff_t>(coded_);
    const std::size_t size = (batch_.size() - coded_) / parts_left_--;
    std::vector<BatchSplit> part(begin, begin + static_cast<std::ptrdiff_t>(size));
    SplitCoder<ChunkWriter> coder(chunk, header_, model_, mesh_, state_);
    [[maybe_unused]] Status done =
        coder.code(part, static_cast<std::uint32_t>(size), order, parameters_);
    assert(done.ok());
    const std::uint32_t first_vertex = mesh_.vertex_count();
    done = state_.apply(part, mesh_);
    assert(done.ok());
    builder_.applied(coded_, state_.order(), first_vertex);
    coded_ += size;
  }

  // Parts come in the order of the sweep, and no splits of new components may join them.
  std::size_t count_parts(std::size_t splits, std::size_t most) const {
    if (step_ > 1 || arrived_ < components_.count()) return 1;
    if (state_.order_of(splits) == BatchOrder::ids) return 1;
    return (splits + most - 1) / most;
  }

  void finish(const Bytes& bytes, ChunkRow& row, Bytes& body) const {
    row.bytes = static_cast<std::uint32_t>(bytes.size());
    row.crc = crc32c(bytes);
    row.digest = digest_section(bytes);
    row.vertices = mesh_.vertex_count();
    row.faces = mesh_.face_count();
    body.insert(body.end(), bytes.begin(), bytes.end());
  }

  const FileHeader& header_;
  std::uint32_t step_;
  const Components& components_;
  std::size_t arrived_;    // components
  double bytes_a_vertex_;  // of those that arrived last
  SplitModel model_;
  RefinableMesh mesh_;
  BatchMesh state_;
  BatchBuilder builder_;
  std::vector<BatchSplit> batch_;  // that was begun
  BatchParameters parameters_;
  std::size_t coded_ = 0, parts_left_ = 0;
};

FileHeader describe(const EncodeInput& input, const Components& components, const Base& chosen) {
  const EncodedBase& base = chosen.coded;
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
  header.vertices = input.base.live_vertices() + input.log.collapses.size();
  header.faces = input.base.live_faces();
  for (const HalfEdgeCollapse& collapse : input.log.collapses) {
    header.faces += static_cast<std::uint64_t>(collapse.removed_faces());
    header.has_borders |= collapse.removed_faces() == 1;
  }
  header.has_relocations = !input.log.kept_before.empty();
  header.has_arrivals = chosen.components < components.count();
  return header;
}

// Rows that fit the prologue, and leave room for a small base in the first 16 KiB.
std::size_t most_rows(const FileIndex& index) {
  FileIndex one_row = index;
  one_row.chunks.resize(1);
  const std::size_t header = prologue_size(index);
  const std::size_t base = index.header.base_bytes;
  const std::size_t room = kMaxPrologueBytes - (base <= kSmallBaseBytes ? base : 0);
  return (room - header) / (prologue_size(one_row) - header);
}

// Base and chunks; fills in the index's rows, and its box from the mesh that they end in.
Result<Bytes> write_body(const EncodeInput& input, const Components& components, const Base& base,
                         FileIndex& index) {
  const std::size_t rows_that_fit = most_rows(index);
  for (std::size_t largest = kLargestChunkBytes;; largest *= 2) {
    Bytes body = base.coded.bytes;
    index.chunks.clear();
    BodyWriter writer(input, index.header, components, base);
    const Result<bool> fits = writer.write(largest, rows_that_fit, index.chunks, body);
    if (!fits) return fits.error();
    if (!*fits) continue;
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
  const Components components(input.base, input.positions, input.log);
  const Result<Base> base = choose_base(components);
  if (!base) return base.error();

  FileIndex index;
  index.header = describe(input, components, *base);
  const Result<Bytes> body = write_body(input, components, *base, index);
  if (!body) return body.error();

  Bytes file = write_hashed_prologue(index);
  // The default limits of a reader are the writer's, too.
  if (const auto readable = parse_prologue(file); !readable) return readable.error();
  file.insert(file.end(), body->begin(), body->end());
  return file;
}

}  // namespace pmesh
