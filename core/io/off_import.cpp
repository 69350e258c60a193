// OFF (Geomview): an optional header word, the counts, a line a vertex, a line a face. What follows
// the coordinates and the corners on their lines (normals, colours, texture) is passed over.
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/io/parsers.h"
#include "core/io/text_scanner.h"

namespace pmesh {
namespace {

constexpr std::uint64_t kLeastVertexBytes = 6;  // "0 0 0" and a line end.
constexpr std::uint64_t kLeastFaceBytes = 8;    // "3 0 1 2" and a line end.

class OffParser {
 public:
  explicit OffParser(ByteView bytes) : text_(bytes) {}

  Result<ImportedMesh> parse();

 private:
  Status parse_header();
  Status check_header_word(std::string_view word);
  Status parse_counts();
  Result<std::uint64_t> parse_count();
  Status parse_vertex();
  Status parse_face(std::uint64_t face);
  Status next_line(std::uint64_t row, std::uint64_t rows, const char* what);

  TextScanner text_;
  ImportedMesh out_;
  std::uint64_t vertices_ = 0;
  std::uint64_t faces_ = 0;
  std::vector<std::uint32_t> corners_;
};

Result<ImportedMesh> OffParser::parse() {
  if (Status header = parse_header(); !header.ok()) return header.error();
  for (std::uint64_t i = 0; i < vertices_; ++i) {
    if (Status line = next_line(i, vertices_, "vertices"); !line.ok()) return line.error();
    if (Status vertex = parse_vertex(); !vertex.ok()) return vertex.error();
  }
  for (std::uint64_t i = 0; i < faces_; ++i) {
    if (Status line = next_line(i, faces_, "faces"); !line.ok()) return line.error();
    if (Status face = parse_face(i); !face.ok()) return face.error();
  }
  if (!is_padding(text_.remaining()) && text_.next_filled_line()) {
    return text_.error("expected " + std::to_string(faces_) + " faces, found more");
  }
  return std::move(out_);
}

Status OffParser::parse_header() {
  if (!text_.next_filled_line()) return text_.error("expected 'OFF', found ''");
  if (!parse_integer(text_.peek())) {
    if (Status word = check_header_word(text_.field()); !word.ok()) return word;
    const bool at_line_end = text_.peek().empty() || text_.peek()[0] == '#';
    if (at_line_end && !text_.next_filled_line()) return text_.error("the file ends early");
  }
  return parse_counts();
}

// The letters before OFF announce texture coordinates, colours and normals.
Status OffParser::check_header_word(std::string_view word) {
  constexpr std::string_view kName = "OFF";
  if (!word.ends_with(kName)) return text_.error("expected 'OFF', found " + in_quotes(word));
  const std::string_view prefix = word.substr(0, word.size() - kName.size());
  if (prefix.find_first_not_of("STCN") != std::string_view::npos) {
    return text_.error(in_quotes(word) + ": only three coordinates a vertex are supported");
  }
  if (text_.peek() == "BINARY") return text_.error("binary OFF is not supported");
  return {};
}

// Vertices, faces, and often edges, which say nothing.
Status OffParser::parse_counts() {
  const Result<std::uint64_t> vertices = parse_count();
  if (!vertices.ok()) return vertices.error();
  const Result<std::uint64_t> faces = parse_count();
  if (!faces.ok()) return faces.error();
  // The last line may lack its end. Compared by division: the product may overflow.
  const std::uint64_t bytes = text_.remaining().size() + 1;
  if (*vertices > bytes / kLeastVertexBytes || *faces > bytes / kLeastFaceBytes) {
    return text_.error(std::to_string(*vertices) + " vertices and " + std::to_string(*faces) +
                       " faces, but " + std::to_string(bytes - 1) + " bytes follow");
  }
  vertices_ = *vertices;
  faces_ = *faces;
  out_.mesh.positions.reserve(vertices_);
  out_.mesh.triangles.reserve(faces_);
  return {};
}

Result<std::uint64_t> OffParser::parse_count() {
  const std::string_view field = text_.field();
  const std::optional<std::int64_t> count = parse_integer(field);
  if (!count || *count < 0) return text_.error("expected a count, found " + in_quotes(field));
  return static_cast<std::uint64_t>(*count);
}

Status OffParser::next_line(std::uint64_t row, std::uint64_t rows, const char* what) {
  if (text_.next_filled_line()) return {};
  return text_.error("the file ends after " + std::to_string(row) + " of " + std::to_string(rows) +
                     " " + what);
}

Status OffParser::parse_vertex() {
  std::array<double, 3> position{};
  if (Status read = text_.read_numbers(position); !read.ok()) return read;
  out_.mesh.positions.push_back({position[0], position[1], position[2]});
  return {};
}

Status OffParser::parse_face(std::uint64_t face) {
  const Result<std::uint64_t> count = parse_count();
  if (!count.ok()) return count.error();
  corners_.clear();
  for (std::uint64_t i = 0; i < *count; ++i) {
    const std::string_view field = text_.field();
    if (field.empty()) {
      return text_.error("expected " + std::to_string(*count) + " corners, found " +
                         std::to_string(i));
    }
    const std::optional<std::int64_t> index = parse_integer(field);
    if (!index) return text_.error("expected a vertex index, found " + in_quotes(field));
    if (*index < 0 || static_cast<std::uint64_t>(*index) >= vertices_) {
      return text_.error("face " + std::to_string(face) + ": " +
                         index_out_of_range(*index, vertices_));
    }
    corners_.push_back(static_cast<std::uint32_t>(*index));
  }
  if (Status appended = append_polygon(out_, corners_); !appended.ok()) {
    return text_.error("face " + std::to_string(face) + ": " + appended.error().message);
  }
  return {};
}

}  // namespace

Result<ImportedMesh> parse_off(ByteView bytes) { return OffParser(bytes).parse(); }

}  // namespace pmesh
