#include "core/pm/format.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "core/base/crc32c.h"
#include "core/base/ids.h"

namespace pmesh {
namespace {

constexpr std::size_t kFixedHeaderBytes = 168;  // up to the strings
constexpr std::size_t kRowBytes = 36;
constexpr std::size_t kArrivalBytes = 8;  // of a row of a file with arrivals, besides
constexpr std::size_t kCrcOffset = 20;
constexpr std::uint8_t kBaseCodecDraco = 1;
constexpr std::uint8_t kGraphLinear = 0;
constexpr std::uint8_t kSplitCodec = 0;
constexpr std::uint16_t kFlagBorders = 1u << 0;
constexpr std::uint16_t kFlagRelocations = 1u << 1;
constexpr std::uint16_t kFlagErrorsMeasured = 1u << 2;
constexpr std::uint16_t kFlagArrivals = 1u << 3;
constexpr std::uint16_t kKnownFlags =
    kFlagBorders | kFlagRelocations | kFlagErrorsMeasured | kFlagArrivals;

// Bytes of prologue that tell its whole length: magic to chunk count.
constexpr std::size_t kSizingBytes = 20;

std::uint16_t flags_of(const FileHeader& header) {
  return static_cast<std::uint16_t>((header.has_borders ? kFlagBorders : 0) |
                                    (header.has_relocations ? kFlagRelocations : 0) |
                                    (header.errors_measured ? kFlagErrorsMeasured : 0) |
                                    (header.has_arrivals ? kFlagArrivals : 0));
}

std::size_t row_size(bool has_arrivals) { return kRowBytes + (has_arrivals ? kArrivalBytes : 0); }

std::size_t header_size(const FileHeader& header) {
  return kFixedHeaderBytes + 3 + header.metric.size() + header.parameters.size() +
         header.unit.size();
}

// CRC-32C over the prologue with the CRC's own field and the content hash taken as zero.
std::uint32_t prologue_crc(ByteView prologue) {
  constexpr std::size_t kAfterHash = kContentHashOffset + sizeof(ContentHash);
  constexpr std::array<std::uint8_t, kAfterHash - kCrcOffset> kZeros{};
  const std::uint32_t crc = crc32c(prologue.first(kCrcOffset));
  return crc32c(prologue.subspan(kAfterHash), crc32c(kZeros, crc));
}

void put_point(ByteWriter& writer, Vec3i point) {
  for (const std::int32_t c : {point.x, point.y, point.z}) {
    writer.put(static_cast<std::uint32_t>(c));
  }
}

Vec3i get_point(ByteReader& reader) {
  Vec3i point;
  for (std::int32_t* c : {&point.x, &point.y, &point.z}) {
    *c = static_cast<std::int32_t>(reader.get<std::uint32_t>());
  }
  return point;
}

void put_string(ByteWriter& writer, const std::string& text) {
  assert(text.size() <= 255);
  writer.put(static_cast<std::uint8_t>(text.size()));
  writer.put(as_bytes(text));
}

std::string get_string(ByteReader& reader) {
  const ByteView text = reader.take(reader.get<std::uint8_t>());
  return {text.begin(), text.end()};
}

bool is_printable(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

void put_header(ByteWriter& writer, const FileIndex& index) {
  const FileHeader& h = index.header;
  writer.put(ByteView(kMagic));
  writer.put(kFormatVersion);
  writer.put(static_cast<std::uint16_t>(header_size(h)));
  writer.put(static_cast<std::uint16_t>(row_size(h.has_arrivals)));
  writer.put(flags_of(h));
  writer.put(static_cast<std::uint32_t>(index.chunks.size()));
  writer.put(std::uint32_t{0});  // CRC, filled in when the rest stands
  writer.put(ByteView(h.content_hash));
  writer.put(h.file_bytes);
  writer.put(h.vertices);
  writer.put(h.faces);
  writer.put(h.base_vertices);
  writer.put(h.base_faces);
  writer.put(h.base_bytes);
  writer.put(h.base_crc);
  writer.put(kBaseCodecDraco);
  writer.put(kGraphLinear);
  writer.put(kSplitCodec);
  writer.put(h.lattice.bits);
  for (const double d : {h.lattice.origin.x, h.lattice.origin.y, h.lattice.origin.z}) writer.put(d);
  writer.put(h.lattice.step);
  put_point(writer, h.box_low);
  put_point(writer, h.box_high);
  writer.put(std::uint64_t{0});  // tail bytes
  writer.put(ByteView(h.base_digest));
  put_string(writer, h.metric);
  put_string(writer, h.parameters);
  put_string(writer, h.unit);
}

// The rms error is written as a float, a share of the largest.
float rms_share(const ChunkRow& row) {
  return static_cast<float>(row.max_error == 0 ? 0 : row.rms_error / row.max_error);
}

// Counts as their growth, which 32 bits hold: so do the file's bounds on what a chunk may add.
void put_row(ByteWriter& writer, const FileIndex& index, std::size_t chunk) {
  const ChunkRow& row = index.chunks[chunk];
  writer.put(row.bytes);
  writer.put(row.crc);
  writer.put(ByteView(row.digest));
  writer.put(static_cast<std::uint32_t>(row.vertices - index.vertices_after(chunk)));
  writer.put(static_cast<std::uint32_t>(row.faces - index.faces_after(chunk)));
  writer.put(row.max_error);
  writer.put(std::bit_cast<std::uint32_t>(rms_share(row)));
  if (!index.header.has_arrivals) return;
  writer.put(static_cast<std::uint32_t>(row.arrivals.vertices));
  writer.put(static_cast<std::uint32_t>(row.arrivals.faces));
}

// The row that follows those already in `index`.
ChunkRow get_row(ByteReader& reader, const FileIndex& index) {
  const std::size_t before = index.chunks.size();
  ChunkRow row;
  row.offset = index.prefix_bytes(before);
  row.bytes = reader.get<std::uint32_t>();
  row.crc = reader.get<std::uint32_t>();
  const ByteView digest = reader.take(row.digest.size());
  std::copy(digest.begin(), digest.end(), row.digest.begin());
  row.vertices = index.vertices_after(before) + reader.get<std::uint32_t>();
  row.faces = index.faces_after(before) + reader.get<std::uint32_t>();
  row.max_error = reader.get_double();
  row.rms_error = std::bit_cast<float>(reader.get<std::uint32_t>()) * row.max_error;
  if (index.header.has_arrivals) {
    row.arrivals.vertices = reader.get<std::uint32_t>();
    row.arrivals.faces = reader.get<std::uint32_t>();
  }
  return row;
}

// What the first kSizingBytes say about the prologue's layout.
struct Layout {
  std::uint16_t header_bytes = 0;
  std::uint16_t row_bytes = 0;
  std::uint16_t flags = 0;
  std::uint32_t chunk_count = 0;

  bool has_arrivals() const { return (flags & kFlagArrivals) != 0; }
  std::uint64_t prologue_bytes() const {
    return header_bytes + std::uint64_t{row_bytes} * chunk_count;
  }
};

Result<Layout> parse_layout(ByteReader& reader) {
  const ByteView magic = reader.take(kMagic.size());
  if (!std::equal(magic.begin(), magic.end(), kMagic.begin())) return bad_input("not a PM file");
  const auto version = reader.get<std::uint16_t>();
  if (version != kFormatVersion) {
    return bad_input("PM format version " + std::to_string(version) + " is not known");
  }
  Layout layout;
  layout.header_bytes = reader.get<std::uint16_t>();
  layout.row_bytes = reader.get<std::uint16_t>();
  layout.flags = reader.get<std::uint16_t>();
  layout.chunk_count = reader.get<std::uint32_t>();
  if (layout.header_bytes < kFixedHeaderBytes + 3 || layout.header_bytes > kMaxHeaderBytes ||
      layout.row_bytes < row_size(layout.has_arrivals()) || layout.row_bytes > kMaxRowBytes ||
      layout.prologue_bytes() > kMaxPrologueBytes) {
    return damaged("header: its sizes are out of range");
  }
  if ((layout.flags & ~kKnownFlags) != 0) return damaged("header: unknown flags");
  return layout;
}

Status parse_header(ByteReader& reader, const Layout& layout, FileHeader& h) {
  h.has_borders = (layout.flags & kFlagBorders) != 0;
  h.has_relocations = (layout.flags & kFlagRelocations) != 0;
  h.errors_measured = (layout.flags & kFlagErrorsMeasured) != 0;
  h.has_arrivals = layout.has_arrivals();
  reader.get<std::uint32_t>();  // CRC, checked by the caller
  const ByteView hash = reader.take(h.content_hash.size());
  std::copy(hash.begin(), hash.end(), h.content_hash.begin());
  h.file_bytes = reader.get<std::uint64_t>();
  h.vertices = reader.get<std::uint64_t>();
  h.faces = reader.get<std::uint64_t>();
  h.base_vertices = reader.get<std::uint64_t>();
  h.base_faces = reader.get<std::uint64_t>();
  h.base_bytes = reader.get<std::uint64_t>();
  h.base_crc = reader.get<std::uint32_t>();
  if (reader.get<std::uint8_t>() != kBaseCodecDraco || reader.get<std::uint8_t>() != kGraphLinear ||
      reader.get<std::uint8_t>() != kSplitCodec) {
    return damaged("header: unknown codec");
  }
  h.lattice.bits = reader.get<std::uint8_t>();
  for (double* d : {&h.lattice.origin.x, &h.lattice.origin.y, &h.lattice.origin.z}) {
    *d = reader.get_double();
  }
  h.lattice.step = reader.get_double();
  h.box_low = get_point(reader);
  h.box_high = get_point(reader);
  if (reader.get<std::uint64_t>() != 0) return damaged("header: a tail is not known");
  const ByteView digest = reader.take(h.base_digest.size());
  std::copy(digest.begin(), digest.end(), h.base_digest.begin());
  h.metric = get_string(reader);
  h.parameters = get_string(reader);
  h.unit = get_string(reader);
  if (reader.failed() || reader.position() > layout.header_bytes) {
    return damaged("header: its strings overrun it");
  }
  if (!is_printable(h.metric) || !is_printable(h.parameters) || !is_printable(h.unit)) {
    return damaged("header: a string is not printable ASCII");
  }
  return {};
}

Status check_lattice(const FileHeader& h) {
  const Lattice& lattice = h.lattice;
  if (lattice.bits < kMinLatticeBits || lattice.bits > kMaxLatticeBits) {
    return damaged("header: lattice bits are out of range");
  }
  const double reach = std::ldexp(lattice.step, lattice.bits);
  for (const double low : {lattice.origin.x, lattice.origin.y, lattice.origin.z}) {
    if (!std::isfinite(low + reach)) return damaged("header: the lattice is not finite");
  }
  if (!(lattice.step > 0)) return damaged("header: the lattice's step is not positive");
  const auto ordered = [&](std::int32_t low, std::int32_t high) {
    return 0 <= low && low <= high && high >> lattice.bits == 0;
  };
  if (!ordered(h.box_low.x, h.box_high.x) || !ordered(h.box_low.y, h.box_high.y) ||
      !ordered(h.box_low.z, h.box_high.z)) {
    return damaged("header: the bounding box is off the lattice");
  }
  return {};
}

// A face has three corners, and every vertex has a face.
bool is_possible(const MeshCounts& counts) {
  return counts.faces > 0 && counts.vertices >= 3 && counts.vertices <= 3 * counts.faces;
}

std::uint64_t most_mesh_bytes(std::uint64_t faces) {
  return kMaxBaseBytesPerFace * faces + kMaxBaseBytesOverhead;
}

Status check_counts(const FileHeader& h, const DecodeLimits& limits) {
  constexpr std::uint64_t kNameable = kNoIndex / 3;  // by 32-bit half-edges
  if (h.faces > std::min(limits.max_faces, kNameable) || h.base_faces > limits.max_base_faces) {
    return Error{ErrorCode::out_of_resources, "header: " + std::to_string(h.faces) + " faces (" +
                                                  std::to_string(h.base_faces) +
                                                  " in the base) exceed the limit"};
  }
  if (!is_possible(h.base_counts())) return damaged("header: impossible counts of the base mesh");
  if (h.base_faces > kMaxBaseFacesPerByte * h.base_bytes ||
      h.base_bytes > most_mesh_bytes(h.base_faces)) {
    return damaged("header: the base's bytes do not fit its faces");
  }
  if (h.file_bytes >> 62 != 0) return damaged("header: impossible file size");
  return {};
}

// Whether the chunk's counts can grow as its row says, and in that many bytes. Precondition: they
// grow.
bool can_grow(const FileIndex& index, std::size_t chunk, const DecodeLimits& limits) {
  const FileHeader& h = index.header;
  const ChunkRow& row = index.chunks[chunk];
  const MeshCounts arrivals = row.arrivals;
  if (arrivals.vertices > row.vertices - index.vertices_after(chunk) ||
      arrivals.faces > row.faces - index.faces_after(chunk)) {
    return false;
  }
  const auto [splits, faces] = index.added_by_splits(chunk);
  std::uint64_t most_bytes = kMaxChunkOverhead + h.max_split_bytes() * splits;
  if (arrivals != MeshCounts{}) {
    if (!is_possible(arrivals) || arrivals.faces > kMaxBaseFacesPerByte * row.bytes ||
        arrivals.faces > limits.max_base_faces) {
      return false;
    }
    most_bytes += most_mesh_bytes(arrivals.faces);
  }
  const bool fits_splits =
      h.has_borders ? faces >= splits && faces <= 2 * splits : faces == 2 * splits;
  return fits_splits && splits <= std::uint64_t{8} * row.bytes && row.bytes <= most_bytes;
}

// Sections follow each other without gaps; counts grow as arrivals and splits can make them grow.
Status check_rows(const FileIndex& index, const DecodeLimits& limits) {
  const FileHeader& h = index.header;
  std::uint64_t end = index.base_end(), vertices = h.base_vertices, faces = h.base_faces;
  for (std::size_t c = 0; c < index.chunks.size(); ++c) {
    const ChunkRow& row = index.chunks[c];
    const std::string where = "index row " + std::to_string(c);
    if (row.bytes == 0) return damaged(where + ": no bytes");
    if (row.vertices <= vertices || row.faces <= faces) {
      return damaged(where + ": counts do not grow");
    }
    if (!can_grow(index, c, limits)) return damaged(where + ": impossible counts");
    const auto is_length = [](double d) { return std::isfinite(d) && d >= 0; };
    if (h.errors_measured && !(is_length(row.max_error) && is_length(row.rms_error))) {
      return damaged(where + ": an error is not a number");
    }
    end = row.end();
    vertices = row.vertices;
    faces = row.faces;
  }
  if (end != h.file_bytes || vertices != h.vertices || faces != h.faces) {
    return damaged("index: its rows do not add up to the header's totals");
  }
  return {};
}

}  // namespace

std::string to_hex(ByteView bytes) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  text.reserve(2 * bytes.size());
  for (const std::uint8_t byte : bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

std::size_t prologue_size(const FileIndex& index) {
  return header_size(index.header) + row_size(index.header.has_arrivals) * index.chunks.size();
}

Bytes write_prologue(FileIndex& index) {
  assert(header_size(index.header) <= kMaxHeaderBytes && prologue_size(index) <= kMaxPrologueBytes);
  index.prologue_bytes = static_cast<std::uint32_t>(prologue_size(index));
  std::uint64_t end = index.base_end();
  for (ChunkRow& row : index.chunks) {
    row.offset = end;
    if (!index.header.errors_measured) row.max_error = row.rms_error = -1;
    row.rms_error = rms_share(row) * row.max_error;
    end = row.end();
  }
  index.header.file_bytes = end;

  Bytes bytes;
  ByteWriter writer(bytes);
  put_header(writer, index);
  for (std::size_t c = 0; c < index.chunks.size(); ++c) put_row(writer, index, c);
  const std::uint32_t crc = prologue_crc(bytes);
  for (std::size_t i = 0; i < 4; ++i)
    bytes[kCrcOffset + i] = static_cast<std::uint8_t>(crc >> 8 * i);
  return bytes;
}

Result<std::optional<FileIndex>> parse_prologue(ByteView prefix, const DecodeLimits& limits) {
  const std::size_t seen = std::min(prefix.size(), kMagic.size());
  if (!std::equal(prefix.begin(), prefix.begin() + static_cast<std::ptrdiff_t>(seen),
                  kMagic.begin())) {
    return bad_input("not a PM file");
  }
  if (prefix.size() < kSizingBytes) return std::optional<FileIndex>();
  ByteReader reader(prefix);
  const Result<Layout> layout = parse_layout(reader);
  if (!layout) return layout.error();
  if (prefix.size() < layout->prologue_bytes()) return std::optional<FileIndex>();

  const ByteView prologue = prefix.first(layout->prologue_bytes());
  ByteReader crc_field(prologue.subspan(kCrcOffset));
  if (limits.verify_checksums && crc_field.get<std::uint32_t>() != prologue_crc(prologue)) {
    return damaged("header and index: wrong checksum");
  }
  FileIndex index;
  index.prologue_bytes = static_cast<std::uint32_t>(prologue.size());
  if (Status s = parse_header(reader, *layout, index.header); !s) return s.error();
  for (std::uint32_t c = 0; c < layout->chunk_count; ++c) {
    ByteReader row(prologue.subspan(layout->header_bytes + std::size_t{layout->row_bytes} * c));
    index.chunks.push_back(get_row(row, index));
  }
  if (Status s = check_lattice(index.header); !s) return s.error();
  if (Status s = check_counts(index.header, limits); !s) return s.error();
  if (Status s = check_rows(index, limits); !s) return s.error();
  return std::optional<FileIndex>(std::move(index));
}

}  // namespace pmesh
