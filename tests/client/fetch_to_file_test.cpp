#include "client/fetch_to_file.h"

#include <filesystem>
#include <fstream>
#include <utility>

#include <gtest/gtest.h>

#include "core/files/read_file.h"
#include "tests/client/sample.h"
#include "tests/client/scripted_transport.h"

namespace pmesh {
namespace {

using test::extracted;
using test::other_file;
using test::sample_file;
using test::sample_index;
using test::ScriptedTransport;
using test::wish;

class FetchToFile : public testing::Test {
 protected:
  FetchToFile() : folder_(testing::TempDir() + "pmesh_fetch_" + std::to_string(::getpid())) {
    std::filesystem::create_directory(folder_);
  }
  ~FetchToFile() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  Bytes content(const std::string& name) const { return *read_file(path(name)); }
  void put(const std::string& name, ByteView bytes) const {
    std::ofstream(path(name), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<long>(bytes.size()));
  }
  bool exists(const std::string& name) const { return std::filesystem::exists(path(name)); }
  std::size_t file_count() const {
    const std::filesystem::directory_iterator entries(folder_);
    return static_cast<std::size_t>(std::distance(begin(entries), end(entries)));
  }

  Result<FetchReport> fetch(const char* query, const std::string& name, bool force = false) {
    StreamOptions options;
    options.retry.first_delay = std::chrono::milliseconds(0);
    return fetch_to_file(transport_, {wish(query), path(name), force}, options);
  }

  ScriptedTransport transport_{sample_file()};
  std::string folder_;
};

Bytes first(std::uint64_t count) {
  return {sample_file().begin(), sample_file().begin() + static_cast<long>(count)};
}

// Whether a fetch has failed with `text` in its message.
bool says(const Result<FetchReport>& report, const char* text) {
  return !report.ok() && report.error().message.find(text) != std::string::npos;
}

std::uint64_t end_of(const char* query) { return resolve(wish(query), sample_index())->end; }

TEST_F(FetchToFile, WritesTheBytesOfAnExtract) {
  for (const char* query : {"", "faces=1000", "ratio=0.05", "error=1%"}) {
    const Result<FetchReport> report = fetch(query, "out.ply");
    ASSERT_TRUE(report.ok()) << report.error().message;
    EXPECT_EQ(content("out.ply"), extracted(sample_file(), wish(query))) << query;
  }
}

TEST_F(FetchToFile, ReportsWhatItWrote) {
  const FetchReport report = *fetch("faces=5000", "out.obj");
  EXPECT_EQ(report.hash, sample_index().header.content_hash);
  EXPECT_EQ(report.bytes_total, sample_file().size());
  EXPECT_EQ(report.bytes_fetched, end_of("faces=5000"));
  EXPECT_LE(report.faces, 5000u);
  EXPECT_TRUE(report.reached);
  EXPECT_FALSE(report.complete);
}

TEST_F(FetchToFile, GivesTheBaseBelowTheBase) {
  const FetchReport report = *fetch("faces=2", "out.ply");
  EXPECT_EQ(report.faces, sample_index().header.base_faces);
  EXPECT_FALSE(report.reached);
}

TEST_F(FetchToFile, RefusesOtherExtensionsBeforeItConnects) {
  const Result<FetchReport> report = fetch("", "out.stl");
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.error().code, ErrorCode::usage);
  EXPECT_EQ(transport_.opens, 0);
}

TEST_F(FetchToFile, RefusesAnOutputItCannotWriteBeforeItConnects) {
  EXPECT_FALSE(fetch("", "no/such/folder/out.ply").ok());
  EXPECT_EQ(transport_.opens, 0);
}

TEST_F(FetchToFile, LeavesNothingBehindAFailure) {
  transport_.file[sample_index().prologue_bytes] ^= 1;
  EXPECT_FALSE(fetch("", "out.ply").ok());
  EXPECT_FALSE(fetch("", "out.pmesh").ok());
  EXPECT_EQ(file_count(), 0u);
}

TEST_F(FetchToFile, WritesThePrefixThatCoversTheWish) {
  const FetchReport report = *fetch("faces=1000", "out.pmesh");
  EXPECT_EQ(content("out.pmesh"), first(end_of("faces=1000")));
  EXPECT_GE(report.faces, 999u);
  EXPECT_FALSE(report.complete);
}

TEST_F(FetchToFile, WritesNoMoreThanTheWishOfABlindRead) {
  ASSERT_TRUE(fetch("faces=1", "out.pmesh").ok());
  EXPECT_EQ(content("out.pmesh"), first(sample_index().base_end()));
}

TEST_F(FetchToFile, WritesThePrefixOfAnErrorWish) {
  const FetchReport report = *fetch("error=4", "out.pmesh");
  EXPECT_EQ(content("out.pmesh"), first(sample_index().chunks[1].end()));
  EXPECT_EQ(report.faces, sample_index().chunks[1].faces);
  EXPECT_TRUE(report.reached);
}

TEST_F(FetchToFile, WritesEverythingForAnErrorOutOfReach) {
  for (const char* name : {"out.ply", "out.pmesh"}) {
    const FetchReport report = *fetch("error=0", name);
    EXPECT_EQ(report.faces, sample_index().header.faces) << name;
    EXPECT_FALSE(report.reached) << name;
    EXPECT_TRUE(report.complete) << name;
  }
}

TEST_F(FetchToFile, LeavesNothingBehindAWishThatTheFileCannotHave) {
  transport_.file = other_file();
  transport_.block_bytes = 16'384;
  for (const char* name : {"out.ply", "out.pmesh"}) {
    EXPECT_TRUE(says(fetch("error=1", name), "without measured errors")) << name;
  }
  EXPECT_EQ(file_count(), 0u);
}

TEST_F(FetchToFile, ContinuesAPrefix) {
  transport_.hash = sample_index().header.content_hash;
  ASSERT_TRUE(fetch("faces=1000", "out.pmesh").ok());
  const FetchReport report = *fetch("", "out.pmesh");
  EXPECT_EQ(report.bytes_fetched, sample_file().size() - end_of("faces=1000"));
  EXPECT_EQ(content("out.pmesh"), sample_file());
  EXPECT_TRUE(report.complete);
}

TEST_F(FetchToFile, NeverShortensAPrefix) {
  ASSERT_TRUE(fetch("", "out.pmesh").ok());
  const FetchReport report = *fetch("faces=1000", "out.pmesh");
  EXPECT_EQ(content("out.pmesh"), sample_file());
  EXPECT_EQ(report.faces, sample_index().header.faces);
  EXPECT_TRUE(report.complete);
}

TEST_F(FetchToFile, RefusesToContinueAnotherFile) {
  put("out.pmesh", ByteView(other_file()).first(30'000));
  const Result<FetchReport> report = fetch("", "out.pmesh");
  EXPECT_TRUE(says(report, "another")) << report.error().message;
  EXPECT_TRUE(says(report, "--force"));
  EXPECT_EQ(content("out.pmesh").size(), 30'000u);
}

TEST_F(FetchToFile, RefusesToContinueWhatIsNoPmFile) {
  put("out.pmesh", as_bytes("my diary, which must not be lost"));
  const Result<FetchReport> report = fetch("", "out.pmesh");
  ASSERT_FALSE(report.ok());
  EXPECT_NE(report.error().message.find("--force"), std::string::npos);
  EXPECT_EQ(transport_.opens, 0);
}

TEST_F(FetchToFile, StartsOverByForce) {
  put("out.pmesh", other_file());
  ASSERT_TRUE(fetch("faces=1000", "out.pmesh", true).ok());
  EXPECT_EQ(content("out.pmesh"), first(end_of("faces=1000")));
}

TEST_F(FetchToFile, KeepsWholeSectionsOfAFetchThatFails) {
  transport_.file[sample_index().chunks[2].offset] ^= 1;
  const Result<FetchReport> report = fetch("", "out.pmesh");
  EXPECT_TRUE(says(report, "bytes that had come"));
  EXPECT_FALSE(says(report, "run again")) << "the same bytes will come again";
  EXPECT_EQ(content("out.pmesh"), first(sample_index().chunks[1].end()));
}

TEST_F(FetchToFile, SaysToRunAgainAfterALostConnection) {
  bool is_lost = false;
  transport_.cut_after = [&] { return std::exchange(is_lost, true) ? 0u : 12'000u; };
  EXPECT_TRUE(says(fetch("", "out.pmesh"), "run again to continue"));
  EXPECT_GT(content("out.pmesh").size(), sample_index().base_end());
  EXPECT_TRUE(says(fetch("", "out.pmesh"), "run again to continue"));
  EXPECT_TRUE(says(fetch("", "new.pmesh"), "gave up"));
  EXPECT_FALSE(says(fetch("", "new.pmesh"), "run again to continue")) << "there is nothing yet";
}

TEST_F(FetchToFile, SaysToRunAgainAfterTheFileOfAMeshWasReplaced) {
  transport_.cut_after = [this] {
    const bool is_first = transport_.reads.size() == 1;
    if (!is_first) transport_.file = other_file();
    return is_first ? 12'000u : 100'000u;
  };
  EXPECT_TRUE(says(fetch("", "out.ply"), "; run again to fetch the new one"));
}

TEST_F(FetchToFile, SaysHowToStartOverAfterTheRemoteWasReplaced) {
  transport_.cut_after = [this] {
    const bool is_first = transport_.reads.size() == 1;
    if (!is_first) transport_.file = other_file();
    return is_first ? 12'000u : 100'000u;
  };
  const Result<FetchReport> report = fetch("", "out.pmesh");
  EXPECT_TRUE(says(report, "bytes that had come; --force starts over"));
}

TEST_F(FetchToFile, KeepsALongerFileWhenAFetchFails) {
  put("out.pmesh", other_file());
  transport_.file[sample_index().chunks[2].offset] ^= 1;
  EXPECT_FALSE(fetch("", "out.pmesh", true).ok());
  EXPECT_EQ(content("out.pmesh"), other_file());
}

}  // namespace
}  // namespace pmesh
