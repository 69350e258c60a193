// Wavefront OBJ: vertices and faces; every other statement is passed over.
#include <algorithm>
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

class ObjParser {
 public:
  explicit ObjParser(ByteView bytes) : text_(bytes) {}

  Result<ImportedMesh> parse();

 private:
  Status parse_vertex();
  Status parse_face();
  Result<std::uint32_t> parse_corner(std::string_view field);

  std::int64_t vertices() const { return static_cast<std::int64_t>(out_.mesh.positions.size()); }

  TextScanner text_;
  ImportedMesh out_;
  std::vector<std::uint32_t> corners_;
  // A face may name vertices that come later. Of all indices, the largest must prove right.
  std::int64_t largest_index_ = 0;
  std::size_t largest_index_line_ = 0;
};

Result<ImportedMesh> ObjParser::parse() {
  while (text_.next_line()) {
    const std::string_view keyword = text_.field();
    Status parsed;
    if (keyword == "v") parsed = parse_vertex();
    if (keyword == "f") parsed = parse_face();
    if (!parsed.ok()) return parsed.error();
  }
  if (largest_index_ > vertices()) {
    return line_error(largest_index_line_,
                      index_out_of_range(largest_index_, out_.mesh.positions.size()));
  }
  return std::move(out_);
}

// What follows the three coordinates, a weight or a colour, is passed over.
Status ObjParser::parse_vertex() {
  text_.join_continued_lines();
  std::array<double, 3> position{};
  if (Status read = text_.read_numbers(position); !read.ok()) return read;
  out_.mesh.positions.push_back({position[0], position[1], position[2]});
  return {};
}

Status ObjParser::parse_face() {
  text_.join_continued_lines();
  corners_.clear();
  for (std::string_view field = text_.field(); !field.empty(); field = text_.field()) {
    const Result<std::uint32_t> corner = parse_corner(field);
    if (!corner.ok()) return corner.error();
    corners_.push_back(*corner);
  }
  if (Status appended = append_polygon(out_, corners_); !appended.ok()) {
    return text_.error(appended.error().message);
  }
  return {};
}

// v, v/vt, v//vn or v/vt/vn, each counted from 1, or, if negative, back from the latest vertex.
Result<std::uint32_t> ObjParser::parse_corner(std::string_view field) {
  const std::optional<std::int64_t> index = parse_integer(field.substr(0, field.find('/')));
  if (!index) return text_.error("expected a vertex index, found " + in_quotes(field));
  if (*index == 0) return text_.error("vertex index 0: indices begin at 1");
  if (*index < -vertices()) {
    return text_.error(index_out_of_range(*index, out_.mesh.positions.size()));
  }
  if (*index > largest_index_) {
    largest_index_ = *index;
    largest_index_line_ = text_.line();
  }
  // An index that does not fit is larger than any count, and so refused at the end.
  return static_cast<std::uint32_t>(*index > 0 ? *index - 1 : vertices() + *index);
}

}  // namespace

Result<ImportedMesh> parse_obj(ByteView bytes) { return ObjParser(bytes).parse(); }

}  // namespace pmesh
