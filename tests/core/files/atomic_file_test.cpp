#include "core/files/atomic_file.h"

#include <csignal>
#include <filesystem>
#include <utility>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/fixtures/temporary_directory.h"

namespace pmesh {
namespace {

// A limit on the size of files, for a scope: a write beyond it is cut short, then fails.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

class AtomicFileTest : public testing::Test {
 protected:
  std::string target() const { return (folder_ / "out.bin"); }
  std::string leftover() const { return (folder_ / ".out.bin.partial"); }
  Result<AtomicFile> create(Overwrite overwrite = Overwrite::yes) const {
    return AtomicFile::create(target(), overwrite);
  }

  TemporaryDirectory folder_;
};

TEST_F(AtomicFileTest, HoldsAllThatWasWrittenAfterCommit) {
  Result<AtomicFile> file = create();
  ASSERT_TRUE(file.ok());
  EXPECT_TRUE(file->write(as_bytes("first ")).ok());
  EXPECT_TRUE(file->write(as_bytes("second")).ok());
  EXPECT_TRUE(file->commit().ok());
  EXPECT_EQ(contents(target()), "first second");
  EXPECT_EQ(folder_.count(), 1u);
}

TEST_F(AtomicFileTest, WriteFileDoesItAllInOneCall) {
  EXPECT_TRUE(write_file(target(), as_bytes("whole"), Overwrite::no).ok());
  EXPECT_EQ(contents(target()), "whole");
  EXPECT_FALSE(write_file(target(), as_bytes("again"), Overwrite::no).ok());
  EXPECT_EQ(contents(target()), "whole");
}

TEST_F(AtomicFileTest, TargetIsTheOldFileUntilCommit) {
  put_contents(target(), "old");
  Result<AtomicFile> file = create();
  ASSERT_TRUE(file.ok());
  EXPECT_TRUE(file->write(as_bytes("new")).ok());
  EXPECT_EQ(contents(target()), "old");
  EXPECT_TRUE(file->commit().ok());
  EXPECT_EQ(contents(target()), "new");
}

TEST_F(AtomicFileTest, LeavesNothingWithoutCommit) {
  {
    Result<AtomicFile> file = create();
    ASSERT_TRUE(file.ok());
    EXPECT_TRUE(file->write(as_bytes("unfinished")).ok());
    EXPECT_EQ(folder_.count(), 1u);
  }
  EXPECT_EQ(folder_.count(), 0u);
}

TEST_F(AtomicFileTest, MovingKeepsTheFile) {
  Result<AtomicFile> file = create();
  ASSERT_TRUE(file.ok());
  AtomicFile moved = std::move(*file);
  EXPECT_TRUE(moved.write(as_bytes("bytes")).ok());
  EXPECT_TRUE(moved.commit().ok());
  EXPECT_EQ(contents(target()), "bytes");
}

TEST_F(AtomicFileTest, ReusesTheLeftoverOfAKilledRun) {
  const pid_t child = ::fork();
  if (child == 0) {
    Result<AtomicFile> file = create();
    const bool written = file.ok() && file->write(as_bytes("a long unfinished text")).ok();
    ::_exit(written ? 0 : 1);  // No destructor runs.
  }
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_EQ(status, 0);
  ASSERT_EQ(contents(leftover()), "a long unfinished text");
  Result<AtomicFile> file = create();
  ASSERT_TRUE(file.ok());
  EXPECT_TRUE(file->write(as_bytes("short")).ok());
  EXPECT_TRUE(file->commit().ok());
  EXPECT_EQ(contents(target()), "short");
  EXPECT_EQ(folder_.count(), 1u);
}

TEST_F(AtomicFileTest, RefusesASecondWriterOfTheSameTarget) {
  Result<AtomicFile> first = create();
  ASSERT_TRUE(first.ok());
  EXPECT_TRUE(first->write(as_bytes("first")).ok());
  const Result<AtomicFile> second = create();
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(second.error().message, target() + ": another process is writing it");
  EXPECT_TRUE(first->commit().ok());
  EXPECT_EQ(contents(target()), "first");
}

TEST_F(AtomicFileTest, TakesANewWriterAfterTheFirst) {
  Result<AtomicFile> first = create();
  ASSERT_TRUE(first.ok());
  EXPECT_TRUE(first->commit().ok());
  EXPECT_TRUE(create().ok());
}

TEST_F(AtomicFileTest, RefusesToOverwriteIfAsked) {
  put_contents(target(), "old");
  const Result<AtomicFile> file = create(Overwrite::no);
  ASSERT_FALSE(file.ok());
  EXPECT_EQ(file.error().message, target() + ": the file exists");
  EXPECT_EQ(folder_.count(), 1u);
}

TEST_F(AtomicFileTest, RefusesToOverwriteATargetThatCameMeanwhile) {
  {
    Result<AtomicFile> file = create(Overwrite::no);
    ASSERT_TRUE(file.ok());
    put_contents(target(), "meanwhile");
    const Status committed = file->commit();
    ASSERT_FALSE(committed.ok());
    EXPECT_EQ(committed.error().message, target() + ": the file exists");
  }
  EXPECT_EQ(contents(target()), "meanwhile");
  EXPECT_EQ(folder_.count(), 1u);
}

TEST_F(AtomicFileTest, ReportsAFullDisk) {
  put_contents(target(), "old");
  {
    const FileSizeLimit limit(1000);
    Result<AtomicFile> file = create();
    ASSERT_TRUE(file.ok());
    const Status written = file->write(Bytes(2000));
    ASSERT_FALSE(written.ok());
    EXPECT_EQ(written.error().code, ErrorCode::out_of_resources);
    EXPECT_EQ(written.error().message, target() + ": cannot write: File too large");
  }
  EXPECT_EQ(contents(target()), "old");
  EXPECT_EQ(folder_.count(), 1u);
}

TEST_F(AtomicFileTest, RefusesAFolderThatIsNotThere) {
  const std::string path = (folder_ / "absent/out.bin");
  const Result<AtomicFile> file = AtomicFile::create(path, Overwrite::yes);
  ASSERT_FALSE(file.ok());
  EXPECT_EQ(file.error().code, ErrorCode::runtime);
  EXPECT_EQ(file.error().message, path + ": cannot create " + (folder_ / "absent/.out.bin") +
                                      ".partial: No such file or directory");
}

TEST_F(AtomicFileTest, RefusesWhatIsNoRegularFile) {
  for (const std::string& path : {std::string("/dev/null"), (folder_ / "")}) {
    EXPECT_FALSE(AtomicFile::create(path, Overwrite::yes).ok()) << path;
  }
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

}  // namespace
}  // namespace pmesh
