#include "protocol/catalogue_json.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/protocol/sample_index.h"

namespace pmesh {
namespace {

using nlohmann::json;

constexpr char kHash[] = "abcd0000000000000000000000000000";

TEST(CatalogueJson, ListsTheMembersOfEveryMesh) {
  const FileIndex index = testing::sample_index();
  const json list = json::parse(catalogue_json({{"a", &index}, {"b", &index}}));
  const json first = {
      {"id", "a"}, {"hash", kHash}, {"file_bytes", 240}, {"vertices", 42}, {"faces", 80}};
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0], first);
  EXPECT_EQ(list[1]["id"], "b");
}

TEST(CatalogueJson, IsAnEmptyListWithoutMeshes) { EXPECT_EQ(catalogue_json({}), "[]"); }

TEST(MeshInfoJson, HasEveryMember) {
  const FileIndex index = testing::sample_index();
  const json info = json::parse(mesh_info_json({"bunny", &index}));
  EXPECT_EQ(info["base_faces"], 10);
  EXPECT_EQ(info["quantization"], 12);
  EXPECT_EQ(info["bbox"], (json{{"min", {1.0, 2.0, 3.0}}, {"max", {3.0, 3.0, 3.0}}}));
  EXPECT_EQ(info["url"], std::string("/bunny/") + kHash + ".pmesh");
  EXPECT_EQ(info["chunks"].size(), 3u);
}

TEST(MeshInfoJson, GivesErrorsOnlyIfTheHeaderSaysSo) {
  FileIndex index = testing::sample_index_with_errors();
  index.header.errors_measured = false;
  const json unmeasured = json::parse(mesh_info_json({"bunny", &index}))["chunks"];
  EXPECT_TRUE(unmeasured[1]["max_error"].is_null());
  EXPECT_TRUE(unmeasured[1]["rms_error"].is_null());

  index.header.errors_measured = true;
  const json chunks = json::parse(mesh_info_json({"bunny", &index}))["chunks"];
  EXPECT_EQ(chunks[1], (json{{"offset", 170},
                             {"bytes", 30},
                             {"vertices", 22},
                             {"faces", 40},
                             {"max_error", 1.0},
                             {"rms_error", 0.5}}));
}

TEST(MeshInfo, IsReadBack) {
  const FileIndex index = testing::sample_index();
  const auto info = parse_mesh_info(mesh_info_json({"bunny", &index}));
  ASSERT_TRUE(info.ok());
  EXPECT_EQ(info->id, "bunny");
  EXPECT_EQ(info->hash, index.header.content_hash);
  EXPECT_EQ(info->file_bytes, 240u);
  EXPECT_EQ(info->url, std::string("/bunny/") + kHash + ".pmesh");
}

TEST(MeshInfo, RejectsWhatTheServerCannotHaveWritten) {
  const json good = {{"id", "a"}, {"hash", kHash}, {"file_bytes", 1}, {"url", "/x"}};
  ASSERT_TRUE(parse_mesh_info(good.dump()).ok());
  for (const auto& [key, value] : std::vector<std::pair<std::string, json>>{
           {"id", ".."}, {"id", 5}, {"hash", "00"}, {"file_bytes", -1}, {"url", "ftp://x"}}) {
    json bad = good;
    bad[key] = value;
    EXPECT_FALSE(parse_mesh_info(bad.dump()).ok()) << key;
  }
}

TEST(MeshInfo, RejectsOtherText) {
  for (const std::string& text : {std::string(), std::string("[]"), std::string("{"),
                                  std::string("5"), std::string(100000, '[')}) {
    EXPECT_FALSE(parse_mesh_info(text).ok());
  }
}

}  // namespace
}  // namespace pmesh
