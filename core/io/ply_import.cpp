// PLY, after G. Turk's description: a text header (ply_header.h), then each element's rows in
// order, as text or as packed binary values.
#include <array>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/ids.h"
#include "core/io/parsers.h"
#include "core/io/ply_header.h"
#include "core/io/ply_source.h"

namespace pmesh {
namespace {

// Reads the rows of all elements from one of the two sources.
template <class Source>
class RowReader {
 public:
  RowReader(const PlyHeader& header, Source source) : header_(header), source_(source) {}

  Result<ImportedMesh> read();

 private:
  Status read_element(const PlyElement& element);
  Status check_count(const PlyElement& element) const;
  void reserve(const PlyElement& element);
  void read_property(const PlyProperty& property);
  Status finish_row(PlyKind kind);
  Status add_vertex();
  Status add_polygon();
  Status add_strips();
  Status check_corner(std::int64_t corner) const;

  const PlyHeader& header_;
  Source source_;
  ImportedMesh out_;
  // Of the row being read:
  std::array<double, 3> position_{};
  std::vector<std::int64_t> corners_;
  std::vector<std::uint32_t> polygon_;
};

template <class Source>
Result<ImportedMesh> RowReader<Source>::read() {
  for (const PlyElement& element : header_.elements) {
    if (Status status = read_element(element); !status.ok()) return status.error();
  }
  if (Status ended = source_.check_end(); !ended.ok()) return ended.error();
  return std::move(out_);
}

template <class Source>
Status RowReader<Source>::read_element(const PlyElement& element) {
  if (element.properties.empty()) return {};  // Rows without values take no bytes.
  if (Status checked = check_count(element); !checked.ok()) return checked;
  reserve(element);
  for (std::uint64_t row = 0; row < element.count; ++row) {
    if (Status begun = source_.begin_row(element, row); !begun.ok()) return begun;
    for (const PlyProperty& property : element.properties) read_property(property);
    if (Status ended = source_.end_row(element, row); !ended.ok()) return ended;
    if (Status finished = finish_row(element.kind); !finished.ok()) {
      return source_.row_error(element, row, finished.error().message);
    }
  }
  return {};
}

// The claim is compared with the file's size before anything is reserved by it.
template <class Source>
Status RowReader<Source>::check_count(const PlyElement& element) const {
  std::uint64_t row_bytes = 0;
  for (const PlyProperty& property : element.properties) {
    row_bytes += Source::least_bytes(property.is_list ? property.count_type : property.type);
  }
  if (element.count <= (source_.remaining_bytes() + Source::kMissingLineEnd) / row_bytes) return {};
  return bad_input("element " + in_quotes(element.name) + ": " + std::to_string(element.count) +
                   " rows of at least " + std::to_string(row_bytes) + " bytes, but " +
                   std::to_string(source_.remaining_bytes()) + " bytes follow");
}

template <class Source>
void RowReader<Source>::reserve(const PlyElement& element) {
  if (element.kind == PlyKind::vertices) out_.mesh.positions.reserve(element.count);
  if (element.kind == PlyKind::polygons) out_.mesh.triangles.reserve(element.count);
}

template <class Source>
void RowReader<Source>::read_property(const PlyProperty& property) {
  switch (property.role) {
    case PlyRole::x:
      position_[0] = source_.number(property.type);
      return;
    case PlyRole::y:
      position_[1] = source_.number(property.type);
      return;
    case PlyRole::z:
      position_[2] = source_.number(property.type);
      return;
    case PlyRole::corners:
      corners_.resize(source_.list_length(property));
      for (std::int64_t& corner : corners_) corner = source_.integer(property.type);
      return;
    case PlyRole::ignored:
      source_.skip(property.type, property.is_list ? source_.list_length(property) : 1);
  }
}

template <class Source>
Status RowReader<Source>::finish_row(PlyKind kind) {
  switch (kind) {
    case PlyKind::vertices:
      return add_vertex();
    case PlyKind::polygons:
      return add_polygon();
    case PlyKind::strips:
      return add_strips();
    case PlyKind::other:
      return {};
  }
  return {};
}

template <class Source>
Status RowReader<Source>::add_vertex() {
  for (const double coordinate : position_) {
    if (!std::isfinite(coordinate)) return bad_input("a coordinate is not finite");
  }
  out_.mesh.positions.push_back({position_[0], position_[1], position_[2]});
  return {};
}

template <class Source>
Status RowReader<Source>::check_corner(std::int64_t corner) const {
  if (corner >= 0 && static_cast<std::uint64_t>(corner) < header_.vertices) return {};
  return bad_input(index_out_of_range(corner, header_.vertices));
}

template <class Source>
Status RowReader<Source>::add_polygon() {
  polygon_.clear();
  for (const std::int64_t corner : corners_) {
    if (Status checked = check_corner(corner); !checked.ok()) return checked;
    polygon_.push_back(static_cast<std::uint32_t>(corner));
  }
  return append_polygon(out_, polygon_);
}

// Every second triangle of a strip is turned over, so that all face the same way.
template <class Source>
Status RowReader<Source>::add_strips() {
  std::uint32_t before_last = kNoIndex;
  std::uint32_t last = kNoIndex;
  bool turned = false;
  for (const std::int64_t corner : corners_) {
    if (corner == -1) {
      before_last = last = kNoIndex;
      turned = false;
      continue;
    }
    if (Status checked = check_corner(corner); !checked.ok()) return checked;
    const auto next = static_cast<std::uint32_t>(corner);
    if (before_last != kNoIndex) {
      out_.mesh.triangles.push_back(turned ? Triangle{last, before_last, next}
                                           : Triangle{before_last, last, next});
      turned = !turned;
    }
    before_last = std::exchange(last, next);
  }
  return {};
}

template <class Source>
Result<ImportedMesh> read_rows(const PlyHeader& header, Source source) {
  return RowReader<Source>(header, source).read();
}

}  // namespace

Result<ImportedMesh> parse_ply(ByteView bytes) {
  TextScanner text(bytes);
  const Result<PlyHeader> header = parse_ply_header(text);
  if (!header.ok()) return header.error();
  using std::endian;
  switch (header->encoding) {
    case PlyEncoding::ascii:
      return read_rows(*header, PlyTextSource(text));
    case PlyEncoding::little_endian:
      return read_rows(*header, PlyBinarySource<endian::little>(text.remaining()));
    case PlyEncoding::big_endian:
      return read_rows(*header, PlyBinarySource<endian::big>(text.remaining()));
  }
  return bad_input("unknown format");
}

}  // namespace pmesh
