#include "core/io/ply_header.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

namespace pmesh {
namespace {

constexpr std::pair<std::string_view, PlyType> kTypeNames[] = {
    {"char", PlyType::int8},      {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
    {"uint8", PlyType::uint8},    {"short", PlyType::int16},     {"int16", PlyType::int16},
    {"ushort", PlyType::uint16},  {"uint16", PlyType::uint16},   {"int", PlyType::int32},
    {"int32", PlyType::int32},    {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
    {"float", PlyType::float32},  {"float32", PlyType::float32}, {"double", PlyType::float64},
    {"float64", PlyType::float64}};

constexpr std::pair<std::string_view, PlyEncoding> kEncodings[] = {
    {"ascii", PlyEncoding::ascii},
    {"binary_little_endian", PlyEncoding::little_endian},
    {"binary_big_endian", PlyEncoding::big_endian}};

constexpr std::pair<std::string_view, PlyKind> kKinds[] = {
    {"vertex", PlyKind::vertices}, {"face", PlyKind::polygons}, {"tristrips", PlyKind::strips}};

template <class Value, std::size_t kCount>
std::optional<Value> look_up(const std::pair<std::string_view, Value> (&table)[kCount],
                             std::string_view name) {
  for (const auto& [known, value] : table) {
    if (known == name) return value;
  }
  return std::nullopt;
}

bool is_integer(PlyType type) { return type < PlyType::float32; }

PlyRole role_of(const PlyProperty& property, PlyKind kind) {
  if (kind == PlyKind::vertices && !property.is_list) {
    if (property.name == "x") return PlyRole::x;
    if (property.name == "y") return PlyRole::y;
    if (property.name == "z") return PlyRole::z;
  }
  const bool is_face = kind == PlyKind::polygons || kind == PlyKind::strips;
  const bool is_corners = property.name == "vertex_indices" || property.name == "vertex_index";
  return is_face && is_corners ? PlyRole::corners : PlyRole::ignored;
}

// Parses the header's lines, one member function a keyword.
class HeaderParser {
 public:
  explicit HeaderParser(TextScanner& text) : text_(text) {}

  Result<PlyHeader> parse();

 private:
  Status parse_line(std::string_view keyword);
  Status parse_format();
  Status parse_element();
  Status parse_property();
  Result<PlyType> parse_type();
  Status check_last_element() const;
  bool has_role(PlyRole role) const;

  TextScanner& text_;
  PlyHeader header_;
  bool has_format_ = false;
};

Result<PlyHeader> HeaderParser::parse() {
  text_.next_line();
  if (const std::string_view magic = text_.field(); magic != "ply") {
    return text_.error("expected 'ply', found " + in_quotes(magic));
  }
  while (text_.next_line()) {
    const std::string_view keyword = text_.field();
    const bool at_end = keyword == "end_header";
    if (at_end && !has_format_) return text_.error("the header has no line 'format'");
    Status parsed = at_end ? check_last_element() : parse_line(keyword);
    if (!parsed.ok()) return parsed.error();
    if (at_end) return std::move(header_);
  }
  return text_.error("the file ends inside the header");
}

Status HeaderParser::parse_line(std::string_view keyword) {
  if (keyword.empty() || keyword == "comment" || keyword == "obj_info") return {};
  if (keyword == "format") return parse_format();
  if (keyword == "element") return parse_element();
  if (keyword == "property") return parse_property();
  if (keyword == "Created") return {};  // Old exporters of Blender forgot the word "comment".
  return text_.error("unknown header keyword " + in_quotes(keyword));
}

Status HeaderParser::parse_format() {
  const std::string_view name = text_.field();
  const std::optional<PlyEncoding> encoding = look_up(kEncodings, name);
  if (!encoding) return text_.error("unknown format " + in_quotes(name));
  header_.encoding = *encoding;
  has_format_ = true;
  return {};
}

Status HeaderParser::parse_element() {
  if (Status checked = check_last_element(); !checked.ok()) return checked;
  PlyElement element;
  element.name = text_.field();
  const std::string_view count_field = text_.field();
  const std::optional<std::int64_t> count = parse_integer(count_field);
  if (!count || *count < 0) return text_.error("expected a count, found " + in_quotes(count_field));
  element.count = static_cast<std::uint64_t>(*count);
  element.kind = look_up(kKinds, element.name).value_or(PlyKind::other);
  for (const PlyElement& other : header_.elements) {
    if (element.kind != PlyKind::other && element.kind == other.kind) {
      return text_.error("element " + in_quotes(element.name) + " occurs twice");
    }
  }
  if (element.kind == PlyKind::vertices) header_.vertices = element.count;
  header_.elements.push_back(std::move(element));
  return {};
}

Result<PlyType> HeaderParser::parse_type() {
  const std::string_view name = text_.field();
  const std::optional<PlyType> type = look_up(kTypeNames, name);
  if (!type) return text_.error("unknown property type " + in_quotes(name));
  return *type;
}

Status HeaderParser::parse_property() {
  if (header_.elements.empty()) return text_.error("a property before the first element");
  PlyProperty property;
  property.is_list = text_.peek() == "list";
  if (property.is_list) {
    text_.field();
    const Result<PlyType> count_type = parse_type();
    if (!count_type.ok()) return count_type.error();
    if (!is_integer(*count_type)) return text_.error("a list's length must be an integer");
    property.count_type = *count_type;
  }
  const Result<PlyType> type = parse_type();
  if (!type.ok()) return type.error();
  property.type = *type;
  property.name = text_.field();
  property.role = role_of(property, header_.elements.back().kind);
  if (property.role == PlyRole::corners && !(property.is_list && is_integer(property.type))) {
    return text_.error(in_quotes(property.name) + " must be a list of integers");
  }
  if (property.role != PlyRole::ignored && has_role(property.role)) {
    return text_.error("property " + in_quotes(property.name) + " occurs twice");
  }
  header_.elements.back().properties.push_back(std::move(property));
  return {};
}

bool HeaderParser::has_role(PlyRole role) const {
  const auto& properties = header_.elements.back().properties;
  return std::any_of(properties.begin(), properties.end(),
                     [role](const PlyProperty& property) { return property.role == role; });
}

Status HeaderParser::check_last_element() const {
  if (header_.elements.empty()) return {};
  const PlyElement& element = header_.elements.back();
  const auto need = [&](PlyRole role, const char* name) -> Status {
    if (has_role(role)) return {};
    return text_.error("element " + in_quotes(element.name) + " has no property '" + name + "'");
  };
  switch (element.kind) {
    case PlyKind::vertices: {
      if (Status has_x = need(PlyRole::x, "x"); !has_x.ok()) return has_x;
      if (Status has_y = need(PlyRole::y, "y"); !has_y.ok()) return has_y;
      return need(PlyRole::z, "z");
    }
    case PlyKind::polygons:
    case PlyKind::strips:
      return need(PlyRole::corners, "vertex_indices");
    case PlyKind::other:
      return {};
  }
  return {};
}

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      return 8;
  }
  return 0;
}

Result<PlyHeader> parse_ply_header(TextScanner& text) { return HeaderParser(text).parse(); }

}  // namespace pmesh
