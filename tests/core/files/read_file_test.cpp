#include "core/files/read_file.h"

#include <array>
#include <filesystem>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/fixtures/temporary_directory.h"

namespace pmesh {
namespace {

std::string as_text(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

TEST(ReadFile, GivesAllBytes) {
  const TemporaryDirectory folder;
  const std::string path = (folder / "data");
  for (const std::string text : {"", "x", "some bytes\n"}) {
    put_contents(path, text);
    const Result<Bytes> bytes = read_file(path);
    ASSERT_TRUE(bytes.ok());
    EXPECT_EQ(as_text(*bytes), text);
  }
}

TEST(ReadFile, ReadsAPipeOfUnknownLength) {
  const TemporaryDirectory folder;
  const std::string path = (folder / "pipe");
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  const std::string text(3'000'000, 'x');
  std::thread writer([&] { put_contents(path, text); });
  const Result<Bytes> bytes = read_file(path);
  writer.join();
  ASSERT_TRUE(bytes.ok());
  EXPECT_EQ(as_text(*bytes), text);
}

TEST(ReadFile, RefusesMoreThanTheLimit) {
  const TemporaryDirectory folder;
  const std::string path = (folder / "data");
  put_contents(path, "123456");
  EXPECT_TRUE(read_file(path, 6).ok());
  const Result<Bytes> bytes = read_file(path, 5);
  ASSERT_FALSE(bytes.ok());
  EXPECT_EQ(bytes.error().code, ErrorCode::out_of_resources);
  EXPECT_EQ(bytes.error().message, path + ": larger than the limit of 5 bytes");
}

TEST(ReadFile, RefusesMoreThanTheLimitFromADevice) {
  EXPECT_EQ(read_file("/dev/zero", 5'000'000).error().code, ErrorCode::out_of_resources);
}

TEST(ReadFile, NamesAFileThatIsNotThere) {
  const Result<Bytes> bytes = read_file("/absent/file");
  ASSERT_FALSE(bytes.ok());
  EXPECT_EQ(bytes.error().code, ErrorCode::runtime);
  EXPECT_EQ(bytes.error().message, "/absent/file: cannot open: No such file or directory");
}

TEST(ReadFile, RefusesAFolder) {
  const TemporaryDirectory folder;
  EXPECT_EQ(read_file((folder / "")).error().message,
            (folder / "") + ": cannot read: Is a directory");
}

TEST(RandomAccessFile, ReadsExactSpans) {
  const TemporaryDirectory folder;
  put_contents((folder / "data"), "0123456789");
  const Result<RandomAccessFile> file = RandomAccessFile::open((folder / "data"));
  ASSERT_TRUE(file.ok());
  EXPECT_EQ(file->size(), 10u);
  std::array<std::uint8_t, 4> span{};
  ASSERT_TRUE(file->read(6, span).ok());
  EXPECT_EQ(std::string(span.begin(), span.end()), "6789");
}

TEST(RandomAccessFile, RefusesToReadPastTheEnd) {
  const TemporaryDirectory folder;
  put_contents((folder / "data"), "0123456789");
  const Result<RandomAccessFile> file = RandomAccessFile::open((folder / "data"));
  ASSERT_TRUE(file.ok());
  std::array<std::uint8_t, 4> span{};
  const Status read = file->read(7, span);
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error().message, (folder / "data") + ": ends at byte 10");
}

TEST(RandomAccessFile, KeepsReadingAFileThatWasReplaced) {
  const TemporaryDirectory folder;
  put_contents((folder / "data"), "old");
  const Result<RandomAccessFile> file = RandomAccessFile::open((folder / "data"));
  ASSERT_TRUE(file.ok());
  put_contents((folder / "other"), "new");
  std::filesystem::rename((folder / "other"), (folder / "data"));
  std::array<std::uint8_t, 3> span{};
  ASSERT_TRUE(file->read(0, span).ok());
  EXPECT_EQ(std::string(span.begin(), span.end()), "old");
}

TEST(RandomAccessFile, OpensRegularFilesOnly) {
  EXPECT_EQ(RandomAccessFile::open("/dev/null").error().message, "/dev/null: is no regular file");
}

}  // namespace
}  // namespace pmesh
