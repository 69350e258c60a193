#include "server/export/static_export.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "protocol/catalogue_json.h"
#include "tests/fixtures/temporary_directory.h"
#include "tests/server/sample_file.h"

namespace pmesh {
namespace {

namespace fs = std::filesystem;
using pmesh::testing::make_sample;
using pmesh::testing::SampleFile;

class StaticExport : public ::testing::Test {
 protected:
  StaticExport() {
    fs::create_directory(meshes_ / "scans");
    meshes_.write("bunny.pmesh", bunny_.bytes);
    meshes_.write("scans/dragon.pmesh", dragon_.bytes);
  }

  Result<ExportReport> run(bool delete_stale = false) {
    return export_static(meshes_ / "", output_, delete_stale);
  }
  std::string exported(const std::string& name) const { return contents(output_ + "/" + name); }
  bool exists(const std::string& name) const { return fs::exists(output_ + "/" + name); }

  const SampleFile bunny_ = make_sample({100, 200, 300}, 1);
  const SampleFile dragon_ = make_sample({100, 200}, 2);
  const TemporaryDirectory meshes_;
  const TemporaryDirectory parent_;
  const std::string output_ = parent_ / "out";
};

TEST_F(StaticExport, WritesFilesAndChunksUnderTheServersNames) {
  const auto report = run();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->meshes.size(), 2u);
  EXPECT_EQ(exported("bunny/" + bunny_.hash() + ".pmesh"), bunny_.text());
  const ChunkRow& row = bunny_.index.chunks[1];
  EXPECT_EQ(exported("bunny/" + bunny_.hash() + "/c/1"), bunny_.text(row.offset, row.end()));
  EXPECT_EQ(exported("scans~dragon/" + dragon_.hash() + ".pmesh"), dragon_.text());
}

TEST_F(StaticExport, SaysOfTheMeshesWhatTheServerSays) {
  ASSERT_TRUE(run());
  const std::vector<CatalogueEntry> entries = {{"bunny", &bunny_.index},
                                               {"scans~dragon", &dragon_.index}};
  EXPECT_EQ(exported("catalog"), catalogue_json(entries));
  EXPECT_EQ(exported("bunny/index.json"), mesh_info_json(entries[0]));
}

TEST_F(StaticExport, WritesNothingTheSecondTime) {
  ASSERT_TRUE(run());
  const auto again = run();
  EXPECT_EQ(again->files_written, 0u);
  EXPECT_FALSE(again->meshes[0].is_new);
}

TEST_F(StaticExport, WritesAnewWhatAnInterruptedRunLeft) {
  ASSERT_TRUE(run());
  const std::string target = output_ + "/bunny/" + bunny_.hash() + ".pmesh";
  fs::resize_file(target, 10);
  EXPECT_TRUE(run()->meshes[0].is_new);
  EXPECT_EQ(contents(target), bunny_.text());
}

TEST_F(StaticExport, SkipsAnAlteredFileAndLeavesNoHalfOfIt) {
  Bytes altered = bunny_.bytes;
  altered.back() ^= 1;
  meshes_.write("bunny.pmesh", altered);
  const auto report = run();
  ASSERT_TRUE(report);
  EXPECT_EQ(report->meshes.size(), 1u);
  EXPECT_EQ(report->skipped.at(meshes_ / "bunny.pmesh"), "chunk 2: altered");
  EXPECT_FALSE(exists("bunny/" + bunny_.hash() + ".pmesh"));
  EXPECT_EQ(exported("catalog").find("bunny"), std::string::npos);
}

TEST_F(StaticExport, SkipsWhatIsNoMeshAndSaysWhy) {
  put_contents(meshes_ / "text.pmesh", "no PM file");
  meshes_.write("cut.pmesh", ByteView(dragon_.bytes).first(dragon_.bytes.size() - 1));
  put_contents(meshes_ / "a b.pmesh", "");
  fs::create_directory_symlink("/", meshes_ / "root");
  fs::create_symlink("/etc/passwd", meshes_ / "link.pmesh");
  fs::create_directory(meshes_ / "directory.pmesh");
  const auto report = run();
  ASSERT_TRUE(report);
  EXPECT_EQ(report->meshes.size(), 2u);
  EXPECT_EQ(report->skipped.size(), 6u);
  EXPECT_EQ(report->skipped.at(meshes_ / "cut.pmesh"), "incomplete");
  EXPECT_EQ(report->skipped.at(meshes_ / "root"), "a link to a directory");
}

TEST_F(StaticExport, DeletesStaleNamesOnlyWhenAsked) {
  ASSERT_TRUE(run());
  meshes_.write("bunny.pmesh", dragon_.bytes);
  fs::remove(meshes_ / "scans/dragon.pmesh");
  const auto kept = run();
  EXPECT_EQ(kept->stale,
            (std::vector<std::string>{"bunny/" + bunny_.hash(), "bunny/" + bunny_.hash() + ".pmesh",
                                      "scans~dragon/" + dragon_.hash(),
                                      "scans~dragon/" + dragon_.hash() + ".pmesh",
                                      "scans~dragon/index.json"}));
  EXPECT_TRUE(exists(kept->stale.back()));
  ASSERT_TRUE(run(true));
  EXPECT_FALSE(exists("scans~dragon"));
  EXPECT_FALSE(exists("bunny/" + bunny_.hash()));
  EXPECT_TRUE(exists("bunny/" + dragon_.hash() + ".pmesh"));
}

TEST_F(StaticExport, DeletesNothingThatIsNotItsOwn) {
  ASSERT_TRUE(run());
  put_contents(output_ + "/bunny/notes.txt", "mine");
  put_contents(output_ + "/robots.txt", "mine");
  const TemporaryDirectory elsewhere;
  put_contents(elsewhere / "index.json", "mine");
  fs::create_directory_symlink(elsewhere / "", output_ + "/linked");
  fs::remove(meshes_ / "bunny.pmesh");
  ASSERT_TRUE(run(true));
  EXPECT_FALSE(exists("bunny/index.json"));
  EXPECT_TRUE(exists("bunny/notes.txt") && exists("robots.txt"));
  EXPECT_TRUE(fs::exists(elsewhere / "index.json"));
}

TEST_F(StaticExport, KeepsTheFilesOfAMeshThatIsSkippedNow) {
  ASSERT_TRUE(run());
  put_contents(meshes_ / "bunny.pmesh", "being written");
  const auto report = run(true);
  EXPECT_TRUE(report->stale.empty());
  EXPECT_TRUE(exists("bunny/" + bunny_.hash() + ".pmesh"));
}

TEST_F(StaticExport, RefusesToWriteIntoWhatItReads) {
  EXPECT_EQ(export_static(meshes_ / "", meshes_ / "out", false).error().code, ErrorCode::usage);
  EXPECT_EQ(export_static(meshes_ / "", meshes_ / "", false).error().code, ErrorCode::usage);
  EXPECT_EQ(export_static(meshes_ / "none", output_, false).error().code, ErrorCode::usage);
}

TEST_F(StaticExport, FailsIfTheOutputCannotBeWritten) {
  put_contents(output_, "a file");
  EXPECT_FALSE(run());
}

}  // namespace
}  // namespace pmesh
