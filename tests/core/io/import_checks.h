// What the tests of all importers share.
#pragma once

#include <bit>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "core/io/import.h"

namespace pmesh {

/// parse_mesh(), which must succeed.
inline ImportedMesh parsed(MeshFormat format, std::string_view text) {
  Result<ImportedMesh> result = parse_mesh(format, as_bytes(text));
  if (!result.ok()) {
    ADD_FAILURE() << result.error().message;
    return {};
  }
  return *std::move(result);
}

/// The message of parse_mesh(), which must fail with bad_input.
inline std::string error_of(MeshFormat format, std::string_view text) {
  const Result<ImportedMesh> result = parse_mesh(format, as_bytes(text));
  if (result.ok()) return "no error";
  EXPECT_EQ(result.error().code, ErrorCode::bad_input);
  return result.error().message;
}

/// `text` with every `from` replaced.
inline std::string replaced(std::string_view text, std::string_view from, std::string_view to) {
  std::string out;
  for (std::size_t at = text.find(from); at != std::string_view::npos; at = text.find(from)) {
    out.append(text.substr(0, at)).append(to);
    text.remove_prefix(at + from.size());
  }
  return out.append(text);
}

/// The bytes of `value`, least significant first, or, if `big_endian`, last.
template <class T>
std::string bytes_of(T value, bool big_endian = false) {
  std::string bytes(sizeof value, '\0');
  std::uint64_t bits = 0;
  if constexpr (sizeof(T) == 8) {
    bits = std::bit_cast<std::uint64_t>(value);
  } else if constexpr (sizeof(T) == 4) {
    bits = std::bit_cast<std::uint32_t>(value);
  } else {
    bits = static_cast<std::make_unsigned_t<T>>(value);
  }
  for (std::size_t i = 0; i < sizeof value; ++i) {
    bytes[big_endian ? sizeof value - 1 - i : i] = static_cast<char>(bits >> (8 * i));
  }
  return bytes;
}

/// A tetrahedron's corners and faces, which several tests write in several formats.
inline const std::vector<Vec3d> kCorners = {{0, 0, 0}, {1, 0, 0}, {0, 1.5, 0}, {0, 0, -0.25}};
inline const std::vector<Triangle> kFaces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

inline void expect_tetrahedron(const ImportedMesh& imported) {
  EXPECT_EQ(imported.mesh.positions, kCorners);
  EXPECT_EQ(imported.mesh.triangles, kFaces);
  EXPECT_EQ(imported.polygons, 0u);
  EXPECT_FALSE(imported.is_soup);
}

}  // namespace pmesh
