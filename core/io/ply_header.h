// The header of a PLY file: which elements follow, in which order, with which properties.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/io/text_scanner.h"

namespace pmesh {

enum class PlyEncoding : std::uint8_t { ascii, little_endian, big_endian };

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes of one binary value.
std::size_t size_of(PlyType type);

/// What the importer makes of a property.
enum class PlyRole : std::uint8_t { x, y, z, corners, ignored };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::int8;        ///< Of the value, or of a list's items.
  PlyType count_type = PlyType::int8;  ///< Of a list's length; an integer type.
  bool is_list = false;
  PlyRole role = PlyRole::ignored;
};

enum class PlyKind : std::uint8_t {
  vertices,
  polygons,  ///< Each row is a face.
  strips,    ///< Each row is a triangle strip; index -1 ends one and begins the next.
  other,
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;  ///< As claimed: not yet compared with the file's size.
  std::vector<PlyProperty> properties;
  PlyKind kind = PlyKind::other;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::uint64_t vertices = 0;  ///< The count of the vertex element.
};

/// Reads the header, up to and including the line `end_header`. A vertex element has x, y and z, a
/// face element one list of corners, of an integer type; neither occurs twice.
Result<PlyHeader> parse_ply_header(TextScanner& text);

}  // namespace pmesh
