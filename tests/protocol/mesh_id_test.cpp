#include "protocol/mesh_id.h"

#include <gtest/gtest.h>

namespace pmesh {
namespace {

TEST(MeshId, TakesLettersDigitsDotsUnderscoresAndDashes) {
  EXPECT_TRUE(is_mesh_id("bunny"));
  EXPECT_TRUE(is_mesh_id("happy_vrip-q14.v2"));
  EXPECT_TRUE(is_mesh_id("scans~2024~bunny"));
}

TEST(MeshId, RejectsWhatCouldLeaveTheDirectory) {
  for (const char* id : {"", ".", "..", "~", "a~", "~a", "a~~b", "..~b", "a~..", "a/b", "a\\b"}) {
    EXPECT_FALSE(is_mesh_id(id)) << id;
  }
}

TEST(MeshId, RejectsHiddenFilesSpacesAndControlCharacters) {
  EXPECT_FALSE(is_mesh_id(".hidden"));
  EXPECT_FALSE(is_mesh_id("a b"));
  EXPECT_FALSE(is_mesh_id("a\nb"));
  EXPECT_FALSE(is_mesh_id(std::string_view("a\0b", 3)));
}

TEST(MeshId, RejectsReservedNamesOnlyWhenWhole) {
  for (const char* id : {"catalog", "health", "metrics", "view", "openapi.json", "assets"}) {
    EXPECT_FALSE(is_mesh_id(id)) << id;
  }
  EXPECT_TRUE(is_mesh_id("health2"));
  EXPECT_TRUE(is_mesh_id("view~health"));
}

TEST(MeshId, RejectsAnIdThatIsTooLong) {
  EXPECT_TRUE(is_mesh_id(std::string(kMaxMeshIdBytes, 'a')));
  EXPECT_FALSE(is_mesh_id(std::string(kMaxMeshIdBytes + 1, 'a')));
}

TEST(MeshId, IsThePathWithoutItsSuffix) {
  EXPECT_EQ(mesh_id_of_path("scans/bunny.pmesh"), "scans~bunny");
  EXPECT_EQ(path_of_mesh_id("scans~bunny"), "scans/bunny.pmesh");
}

TEST(MeshId, IsNotMadeFromOtherPaths) {
  for (const char* path : {"bunny.ply", ".pmesh", "a/.pmesh", "/a.pmesh", "a~b.pmesh",
                           "catalog.pmesh", ".a/b.pmesh", "a b.pmesh"}) {
    EXPECT_EQ(mesh_id_of_path(path), std::nullopt) << path;
  }
}

}  // namespace
}  // namespace pmesh
