// STL: triangles with their corners written out, as text or as records of 50 bytes.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "core/io/parsers.h"
#include "core/io/text_scanner.h"

namespace pmesh {
namespace {

constexpr std::size_t kHeaderBytes = 84;  // 80 of text and the count.
constexpr std::size_t kRecordBytes = 50;  // Normal, three corners, two bytes of attributes.
constexpr std::size_t kNormalBytes = 12;

void append_triangle(IndexedMesh& mesh) {
  const auto end = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.triangles.push_back({end - 3, end - 2, end - 1});
}

std::uint64_t claimed_triangles(ByteView bytes) {
  return ByteReader(bytes.subspan(kHeaderBytes - 4)).get<std::uint32_t>();
}

// Many binary files begin with "solid" too: the size decides, or else a zero byte early on.
bool is_binary(ByteView bytes) {
  const bool has_header = bytes.size() >= kHeaderBytes;
  if (has_header && bytes.size() == kHeaderBytes + kRecordBytes * claimed_triangles(bytes)) {
    return true;
  }
  TextScanner text(bytes);
  const bool begins_as_text = text.next_filled_line() && same_word(text.field(), "solid");
  const ByteView beginning = bytes.first(std::min(bytes.size(), std::size_t{512}));
  return !begins_as_text || std::count(beginning.begin(), beginning.end(), 0) > 0;
}

Status append_record(ImportedMesh& out, ByteView record, std::uint64_t triangle) {
  ByteReader numbers(record.subspan(kNormalBytes));
  for (int corner = 0; corner < 3; ++corner) {
    std::array<double, 3> p{};
    for (double& coordinate : p) {
      coordinate = std::bit_cast<float>(numbers.get<std::uint32_t>());
      if (std::isfinite(coordinate)) continue;
      return bad_input("triangle " + std::to_string(triangle) + ": a coordinate is not finite");
    }
    out.mesh.positions.push_back({p[0], p[1], p[2]});
  }
  append_triangle(out.mesh);
  return {};
}

Result<ImportedMesh> parse_binary(ByteView bytes) {
  if (bytes.size() < kHeaderBytes) {
    return bad_input("expected 84 bytes of header, found " + std::to_string(bytes.size()));
  }
  const std::uint64_t claimed = claimed_triangles(bytes);
  const ByteView records = bytes.subspan(kHeaderBytes);
  const std::uint64_t held = records.size() / kRecordBytes;
  if (claimed > held || !is_padding(records.subspan(claimed * kRecordBytes))) {
    return bad_input("the header claims " + std::to_string(claimed) + " triangles of " +
                     std::to_string(kRecordBytes) + " bytes, but " +
                     std::to_string(records.size()) + " bytes follow");
  }
  ImportedMesh out;
  out.is_soup = true;
  out.mesh.positions.reserve(3 * claimed);
  out.mesh.triangles.reserve(claimed);
  for (std::uint64_t i = 0; i < claimed; ++i) {
    Status appended = append_record(out, records.subspan(i * kRecordBytes, kRecordBytes), i);
    if (!appended.ok()) return appended.error();
  }
  return out;
}

// Where in the text's nesting a line stands.
enum class Place : std::uint8_t { outside, solid, facet, loop };

struct Statement {
  std::string_view keyword;
  Place before;
  Place after;
};

constexpr Statement kStatements[] = {
    {"solid", Place::outside, Place::solid},   {"facet", Place::solid, Place::facet},
    {"outer", Place::facet, Place::loop},      {"vertex", Place::loop, Place::loop},
    {"endloop", Place::loop, Place::facet},    {"endfacet", Place::facet, Place::solid},
    {"endsolid", Place::solid, Place::outside}};

const Statement* find_statement(std::string_view keyword, Place place) {
  const auto* found =
      std::find_if(std::begin(kStatements), std::end(kStatements), [&](const Statement& statement) {
        return statement.before == place && same_word(keyword, statement.keyword);
      });
  return found == std::end(kStatements) ? nullptr : found;
}

Status append_vertex(ImportedMesh& out, TextScanner& text) {
  std::array<double, 3> p{};
  if (Status read = text.read_numbers(p); !read.ok()) return read;
  out.mesh.positions.push_back({p[0], p[1], p[2]});
  return {};
}

Status end_loop(ImportedMesh& out, const TextScanner& text) {
  const std::size_t corners = out.mesh.positions.size() - 3 * out.mesh.triangles.size();
  if (corners != 3) return text.error("expected 3 corners, found " + std::to_string(corners));
  append_triangle(out.mesh);
  return {};
}

Result<ImportedMesh> parse_text(ByteView bytes) {
  ImportedMesh out;
  out.is_soup = true;
  TextScanner text(bytes);
  Place place = Place::outside;
  while (text.next_filled_line()) {
    const std::string_view keyword = text.field();
    const Statement* statement = find_statement(keyword, place);
    if (statement == nullptr) return text.error("unexpected " + in_quotes(keyword));
    Status done;
    if (statement->keyword == "vertex") done = append_vertex(out, text);
    if (statement->keyword == "endloop") done = end_loop(out, text);
    if (!done.ok()) return done.error();
    place = statement->after;
  }
  if (place != Place::outside) return text.error("the file ends before 'endsolid'");
  return out;
}

}  // namespace

Result<ImportedMesh> parse_stl(ByteView bytes) {
  return is_binary(bytes) ? parse_binary(bytes) : parse_text(bytes);
}

}  // namespace pmesh
