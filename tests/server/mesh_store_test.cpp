#include "server/store/mesh_store.h"

#include <filesystem>
#include <fstream>
#include <latch>
#include <thread>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/fixtures/temporary_directory.h"
#include "tests/server/captured_log.h"
#include "tests/server/descriptor_limit.h"
#include "tests/server/sample_file.h"

namespace pmesh {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using testing::make_sample;
using testing::SampleFile;

class MeshStoreTest : public ::testing::Test {
 protected:
  void open() {
    store_ = MeshStore::open(directory_ / "", milliseconds(0), milliseconds(0)).value();
  }

  template <class... Args>
  MeshPtr found(const Args&... args) {
    return store_->find(args...).value();
  }
  ErrorCode error_of(const std::string& id) {
    const auto found = store_->find(id);
    EXPECT_FALSE(found.ok());
    return found ? ErrorCode{} : found.error().code;
  }

  /// Writes over bytes of a file, and moves its time on in case that the clock has not.
  void write_in_place(const std::string& name, std::uint64_t offset, const std::string& bytes) {
    const fs::path path = directory_ / name;
    const auto modified = fs::last_write_time(path);
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(offset)) << bytes;
    file.close();
    fs::last_write_time(path, modified + std::chrono::seconds(++times_written_));
  }

  std::vector<std::string> listed() {
    std::vector<std::string> ids;
    for (const MeshPtr& mesh : store_->list()) ids.push_back(mesh->id());
    return ids;
  }

  /// Puts a file in place as the writer does: by rename.
  void replace(const std::string& name, const Bytes& bytes) {
    directory_.write("incoming", bytes);
    fs::rename(directory_ / "incoming", directory_ / name);
  }

  TemporaryDirectory directory_;
  std::unique_ptr<MeshStore> store_;
  int times_written_ = 0;
  const SampleFile first_ = make_sample({100, 200}, 1);
  const SampleFile second_ = make_sample({100, 200}, 2);
};

TEST_F(MeshStoreTest, ListsFilesOfSubdirectoriesById) {
  fs::create_directories(directory_ / "scans/new");
  directory_.write("scans/new/b.pmesh", first_.bytes);
  directory_.write("a.pmesh", second_.bytes);
  open();
  EXPECT_EQ(listed(), (std::vector<std::string>{"a", "scans~new~b"}));
  EXPECT_EQ(found("scans~new~b")->hash(), first_.index.header.content_hash);
}

TEST_F(MeshStoreTest, SkipsWhatIsNoCompletePmFile) {
  Bytes partial = first_.bytes, longer = first_.bytes, altered = first_.bytes;
  partial.pop_back();
  longer.push_back(0);
  altered[kContentHashOffset] ^= 1;
  directory_.write("partial.pmesh", partial);
  directory_.write("longer.pmesh", longer);
  directory_.write("altered.pmesh", altered);
  directory_.write("empty.pmesh", Bytes());
  directory_.write("text.pmesh", as_bytes("not a mesh"));
  directory_.write("mesh.ply", first_.bytes);
  directory_.write("catalog.pmesh", first_.bytes);
  directory_.write("good.pmesh", first_.bytes);
  fs::create_directory(directory_ / "directory.pmesh");
  open();
  EXPECT_EQ(listed(), std::vector<std::string>{"good"});
  EXPECT_EQ(found("partial"), nullptr);
  EXPECT_EQ(found("directory"), nullptr);
}

TEST_F(MeshStoreTest, FindsNothingOutsideTheDirectory) {
  const TemporaryDirectory outside;
  outside.write("secret.pmesh", first_.bytes);
  fs::create_symlink(outside / "secret.pmesh", directory_ / "link.pmesh");
  fs::create_directory_symlink(outside / "", directory_ / "linked");
  open();
  EXPECT_EQ(found("link"), nullptr);
  EXPECT_EQ(found("linked~secret"), nullptr);
  EXPECT_EQ(found("../secret"), nullptr);
  EXPECT_TRUE(listed().empty());
}

TEST_F(MeshStoreTest, FindsAFileThatCameLater) {
  open();
  EXPECT_EQ(found("late"), nullptr);
  replace("late.pmesh", first_.bytes);
  EXPECT_NE(found("late"), nullptr);
  EXPECT_EQ(listed(), std::vector<std::string>{"late"});
}

TEST_F(MeshStoreTest, ForgetsAFileThatWasRemoved) {
  directory_.write("a.pmesh", first_.bytes);
  open();
  fs::remove(directory_ / "a.pmesh");
  EXPECT_TRUE(listed().empty());
  EXPECT_EQ(found("a"), nullptr);
}

TEST_F(MeshStoreTest, GivesTheNewFileAndKeepsTheOldWhileItIsHeld) {
  directory_.write("a.pmesh", first_.bytes);
  open();
  MeshPtr held = found("a");
  replace("a.pmesh", second_.bytes);
  EXPECT_EQ(found("a")->hash(), second_.index.header.content_hash);
  EXPECT_EQ(found("a", held->hash()), held);
  EXPECT_TRUE(held->intact());

  const ContentHash old = held->hash();
  held.reset();
  EXPECT_EQ(found("a", old), nullptr);
}

TEST_F(MeshStoreTest, TakesAFileThatWasRepaired) {
  directory_.write("a.pmesh", as_bytes("broken"));
  open();
  EXPECT_EQ(found("a"), nullptr);
  directory_.write("a.pmesh", first_.bytes);
  EXPECT_NE(found("a"), nullptr);
}

TEST_F(MeshStoreTest, NoticesAFileWrittenInPlace) {
  directory_.write("a.pmesh", first_.bytes);
  open();
  const MeshPtr mesh = found("a");
  fs::resize_file(directory_ / "a.pmesh", first_.bytes.size() - 1);
  EXPECT_FALSE(mesh->intact());
  EXPECT_EQ(found("a"), nullptr);
}

TEST_F(MeshStoreTest, ServesNoBytesThatWereAlteredInPlace) {
  directory_.write("a.pmesh", first_.bytes);
  open();
  const MeshPtr held = found("a");
  const std::uint64_t place = first_.index.chunks[1].offset + 50;
  write_in_place("a.pmesh", place, "altered");
  EXPECT_EQ(found("a"), nullptr);
  EXPECT_EQ(found("a", held->hash()), nullptr);
  EXPECT_TRUE(listed().empty());

  write_in_place("a.pmesh", first_.index.prologue_bytes, "altered");  // and not by a second look
  EXPECT_EQ(found("a"), nullptr);
  write_in_place("a.pmesh", 0, first_.text());
  EXPECT_NE(found("a"), nullptr);
}

TEST_F(MeshStoreTest, ServesAFileThatWasOnlyTouched) {
  directory_.write("a.pmesh", first_.bytes);
  open();
  write_in_place("a.pmesh", 0, "");
  EXPECT_NE(found("a"), nullptr);
}

TEST_F(MeshStoreTest, HasAGenerationForEachListOfMeshes) {
  directory_.write("a.pmesh", first_.bytes);
  open();
  const std::uint64_t one = store_->generation();
  EXPECT_EQ(store_->generation(), one);
  directory_.write("b.pmesh", first_.bytes);
  const std::uint64_t two = store_->generation();
  EXPECT_GT(two, one);
  replace("b.pmesh", second_.bytes);
  const std::uint64_t three = store_->generation();
  EXPECT_GT(three, two);
  directory_.write("c.pmesh", as_bytes("no mesh"));
  EXPECT_EQ(store_->generation(), three);
  fs::remove(directory_ / "a.pmesh");
  EXPECT_GT(store_->generation(), three);
}

/// Bytes that this process has read from files so far; nothing if the kernel does not tell.
std::optional<std::uint64_t> bytes_read() {
  std::ifstream io("/proc/self/io");
  std::string name;
  std::uint64_t value = 0;
  if (io >> name >> value && name == "rchar:") return value;
  return {};
}

TEST_F(MeshStoreTest, ReadsAFileWrittenInPlaceOnceForAllWhoAsk) {
  const SampleFile large = make_sample({8'000'000, 8'000'000, 8'000'000, 8'000'000});
  directory_.write("a.pmesh", large.bytes);
  open();
  write_in_place("a.pmesh", 0, "");
  const auto before = bytes_read();
  if (!before) GTEST_SKIP() << "no /proc/self/io";
  std::latch begin(8);
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&] {
      begin.arrive_and_wait();
      for (auto mesh = store_->find("a"); !mesh || !*mesh; mesh = store_->find("a")) {
        EXPECT_FALSE(mesh.ok()) << "not found";
        std::this_thread::sleep_for(milliseconds(1));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_GE(*bytes_read() - *before, large.bytes.size());
  EXPECT_LT(*bytes_read() - *before, large.bytes.size() * 3 / 2);
}

TEST_F(MeshStoreTest, GoesOnFailingUntilAReplacedFileCanBeOpened) {
  if (!testing::DescriptorLimit::can_leave_none()) GTEST_SKIP() << "sanitizers need descriptors";
  constexpr milliseconds kLook(50);
  directory_.write("a.pmesh", first_.bytes);
  store_ = MeshStore::open(directory_ / "", milliseconds(0), kLook).value();
  const MeshPtr held = found("a");
  fs::rename(directory_ / "a.pmesh", directory_ / "aside");
  replace("a.pmesh", second_.bytes);
  const testing::CapturedLog log;
  {
    const testing::DescriptorLimit limit(testing::DescriptorLimit::none_left());
    std::this_thread::sleep_for(2 * kLook);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(error_of("a"), ErrorCode::out_of_resources);
    EXPECT_EQ(found("a", held->hash()), held);
    EXPECT_TRUE(listed().empty());
    fs::rename(directory_ / "aside", directory_ / "a.pmesh");  // what stood there before
    EXPECT_FALSE(store_->find("a").ok());
  }
  EXPECT_EQ(found("a")->hash(), first_.index.header.content_hash);
}

TEST_F(MeshStoreTest, FailsForAsLongAsAFileCannotBeOpened) {
  if (!testing::DescriptorLimit::can_leave_none()) GTEST_SKIP() << "sanitizers need descriptors";
  open();
  directory_.write("a.pmesh", first_.bytes);
  const testing::CapturedLog log;
  {
    const testing::DescriptorLimit limit(testing::DescriptorLimit::none_left());
    EXPECT_EQ(error_of("a"), ErrorCode::out_of_resources);
    EXPECT_EQ(error_of("a"), ErrorCode::out_of_resources);
    EXPECT_FALSE(store_->find("a", first_.index.header.content_hash).ok());
    EXPECT_EQ(found("nobody"), nullptr);
  }
  EXPECT_EQ(log.count("skipped"), 1u);
  EXPECT_NE(found("a"), nullptr);
}

TEST_F(MeshStoreTest, OpensMeshesUpToHalfTheDescriptors) {
  const testing::CapturedLog log;
  for (int i = 10; i < 50; ++i) directory_.write(std::to_string(i) + ".pmesh", first_.bytes);
  const testing::DescriptorLimit limit(60);
  open();
  EXPECT_EQ(listed().size(), 30u);
  EXPECT_EQ(error_of("49"), ErrorCode::out_of_resources);
  EXPECT_EQ(log.count("descriptors"), 1u);
  EXPECT_EQ(log.count("skipped"), 0u);

  replace("10.pmesh", second_.bytes);  // takes its own place
  EXPECT_EQ(found("10")->hash(), second_.index.header.content_hash);
  fs::remove(directory_ / "10.pmesh");
  EXPECT_EQ(listed().size(), 30u);
  EXPECT_EQ(found("10"), nullptr);
}

TEST_F(MeshStoreTest, ForgetsNothingWhenAScanEndsEarly) {
  if (!testing::DescriptorLimit::can_leave_none()) GTEST_SKIP() << "sanitizers need descriptors";
  fs::create_directory(directory_ / "scans");
  directory_.write("scans/a.pmesh", first_.bytes);
  open();
  const testing::CapturedLog log;
  const testing::DescriptorLimit limit(testing::DescriptorLimit::none_left());
  EXPECT_EQ(listed(), std::vector<std::string>{"scans~a"});
  EXPECT_EQ(log.count("ended early"), 1u);
}

TEST_F(MeshStoreTest, LogsOnceWhatItPassesOver) {
  for (const char* name : {"sp ace.pmesh", "catalog.pmesh", "a~b.pmesh", "mesh.ply"}) {
    directory_.write(name, first_.bytes);
  }
  fs::create_directory(directory_ / "directory.pmesh");
  ::mkfifo((directory_ / "pipe.pmesh").c_str(), 0600);
  fs::create_symlink("nowhere", directory_ / "dangling.pmesh");
  const testing::CapturedLog log;
  open();
  EXPECT_TRUE(listed().empty());
  for (const char* name : {"sp ace", "catalog", "a~b", "pipe", "dangling"}) {
    EXPECT_EQ(log.count(name), 1u) << name;
  }
  EXPECT_EQ(log.count("skipped"), 5u);
}

TEST_F(MeshStoreTest, DoesNotServeThroughALinkedDirectory) {
  fs::create_directory(directory_ / "sub");
  directory_.write("sub/b.pmesh", first_.bytes);
  fs::create_directory_symlink("sub", directory_ / "link");
  fs::create_symlink("b.pmesh", directory_ / "sub/linked.pmesh");
  const testing::CapturedLog log;
  open();
  EXPECT_EQ(found("link~b"), nullptr);
  EXPECT_EQ(listed(), (std::vector<std::string>{"sub~b", "sub~linked"}));
  EXPECT_EQ(found("link~b"), nullptr);
  EXPECT_EQ(log.count("link to a directory"), 1u);
  EXPECT_EQ(log.count("link/b.pmesh"), 1u);
}

TEST_F(MeshStoreTest, OpensNothingButADirectory) {
  EXPECT_FALSE(MeshStore::open(directory_ / "nowhere").ok());
  EXPECT_FALSE(MeshStore::open(directory_.write("file", Bytes())).ok());
}

}  // namespace
}  // namespace pmesh
