#include "core/pm/stream_decoder.h"

#include <algorithm>
#include <string>

#include "core/base/crc32c.h"

namespace pmesh {
namespace {

// Vertices that memory is taken for before they come: 36 MiB with their faces, 42 if splits
// relocate. Beyond, it grows as they do, whatever the header says.
constexpr std::uint64_t kMostReserved = 1 << 19;

}  // namespace

StreamDecoder::StreamDecoder(BaseDecoder decode_base, const DecodeLimits& limits)
    : decode_base_(decode_base), limits_(limits) {}

Status StreamDecoder::feed(ByteView bytes) {
  while (status_.ok() && !bytes.empty()) {
    if (complete()) {
      status_ = damaged("bytes follow the last chunk");
      break;
    }
    const std::uint64_t wanted = section_bytes();
    if (pending_.empty() && bytes.size() >= wanted && has_index()) {  // a section without a copy
      take_whole_section(bytes.first(wanted));
      bytes = bytes.subspan(wanted);
      continue;
    }
    const std::size_t taken = std::min<std::uint64_t>(wanted - pending_.size(), bytes.size());
    pending_.insert(pending_.end(), bytes.begin(),
                    bytes.begin() + static_cast<std::ptrdiff_t>(taken));
    bytes = bytes.subspan(taken);
    if (!has_index()) {
      take_prologue();
    } else if (pending_.size() == wanted) {
      take_whole_section(pending_);
      pending_.clear();
    }
  }
  return status_;
}

// The length of the section that the next byte belongs to; for the prologue, how far to look.
std::uint64_t StreamDecoder::section_bytes() const {
  if (!has_index()) return kMaxPrologueBytes;
  if (!has_base()) return index_->header.base_bytes;
  return index_->chunks[chunk_count_].bytes;
}

// Parses the prologue once enough of it is pending; what follows it is fed again.
void StreamDecoder::take_prologue() {
  Result<std::optional<FileIndex>> parsed = parse_prologue(pending_, limits_);
  if (!parsed) {
    status_ = parsed.error();
  } else if (parsed->has_value()) {
    index_ = std::move(**parsed);
    usable_bytes_ = index_->prologue_bytes;
    const Bytes fed = std::exchange(pending_, {});
    status_ = feed(ByteView(fed).subspan(index_->prologue_bytes));
  }
}

void StreamDecoder::take_whole_section(ByteView section) {
  status_ = has_base() ? take_chunk(section) : take_base(section);
  if (status_.ok()) {
    usable_bytes_ += section.size();
  } else if (status_.error().code == ErrorCode::bad_input) {
    status_ = damaged(status_.error().message);  // behind a header that stands
  }
}

Status StreamDecoder::take_base(ByteView section) {
  const FileHeader& header = index_->header;
  if (limits_.verify_checksums && crc32c(section) != header.base_crc) {
    return damaged("base mesh: wrong checksum");
  }
  const Result<LatticeMesh> base =
      decode_mesh(decode_base_, section, header.base_counts(), header.lattice);
  if (!base) return prefixed("base mesh", base.error());
  Result<RefinableMesh> mesh = RefinableMesh::from_base(*base);
  if (!mesh) return mesh.error();
  mesh_ = std::move(*mesh);
  mesh_->reserve(static_cast<std::uint32_t>(std::max<std::uint64_t>(
                     mesh_->vertex_count(), std::min(header.vertices, kMostReserved))),
                 static_cast<std::uint32_t>(std::min(header.faces, 2 * kMostReserved)));
  splits_.emplace(*mesh_);
  return {};
}

Status StreamDecoder::take_chunk(ByteView section) {
  const ChunkRow& row = index_->chunks[chunk_count_];
  const std::string where = "chunk " + std::to_string(chunk_count_);
  if (limits_.verify_checksums && crc32c(section) != row.crc) {
    return damaged(where + ": wrong checksum");
  }
  mesh_->set_finest();
  const std::uint32_t steps_before = mesh_->applied_steps();
  Status decoded = decode_chunk(section, chunk_count_);
  if (decoded.ok() && mesh_->face_count() != row.faces) {
    decoded = damaged("its face count differs from the index");
  }
  if (!decoded) {
    mesh_->set_steps(steps_before);
    mesh_->forget_finer();
    return prefixed(where, decoded.error());
  }
  ++chunk_count_;
  return {};
}

Status StreamDecoder::decode_chunk(ByteView section, std::size_t chunk) {
  const ChunkRow& row = index_->chunks[chunk];
  const Result<ChunkParts> parts = chunk_parts(section, row);
  if (!parts) return parts.error();
  if (row.arrivals.faces > 0) {
    const Result<LatticeMesh> components =
        decode_mesh(decode_base_, parts->components, row.arrivals, index_->header.lattice);
    if (!components) return prefixed("new components", components.error());
    if (Status arrived = mesh_->append(*components); !arrived) return arrived;
  }
  const auto splits = static_cast<std::uint32_t>(index_->added_by_splits(chunk).vertices);
  return splits_->decode(parts->splits, splits, index_->header, *mesh_);
}

}  // namespace pmesh
