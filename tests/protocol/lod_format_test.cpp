#include "protocol/lod_format.h"

#include <gtest/gtest.h>

namespace pmesh {
namespace {

TEST(LodFormat, HasOneForEveryEnding) {
  EXPECT_EQ(lod_format_of("glb"), LodFormat::glb);
  EXPECT_EQ(lod_format_of("ply"), LodFormat::ply);
  EXPECT_EQ(lod_format_of("obj"), LodFormat::obj);
  EXPECT_EQ(lod_format_of("drc"), LodFormat::drc);
  for (const char* ending : {"", "GLB", "gltf", "glb ", "stl"}) {
    EXPECT_EQ(lod_format_of(ending), std::nullopt) << ending;
  }
}

TEST(LodFormat, DracoCompressesGlbAlone) {
  EXPECT_EQ(lod_format_of("glb", true), LodFormat::glb_draco);
  EXPECT_EQ(lod_format_of("ply", true), LodFormat::ply);
  EXPECT_EQ(lod_format_of("drc", true), LodFormat::drc);
}

TEST(LodFormat, NamesEach) {
  EXPECT_EQ(format_name(LodFormat::glb), "glb");
  EXPECT_EQ(format_name(LodFormat::glb_draco), "glb-draco");
  EXPECT_EQ(file_ending(LodFormat::glb_draco), "glb");
  EXPECT_EQ(file_ending(LodFormat::drc), "drc");
  EXPECT_EQ(media_type(LodFormat::glb_draco), "model/gltf-binary");
  EXPECT_EQ(media_type(LodFormat::obj), "model/obj");
  EXPECT_EQ(media_type(LodFormat::ply), "application/octet-stream");
}

}  // namespace
}  // namespace pmesh
