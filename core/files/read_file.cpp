#include "core/files/read_file.h"

#include <algorithm>
#include <cerrno>
#include <new>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pmesh {
namespace {

constexpr std::size_t kReadStep = std::size_t{1} << 20;

Error too_large(const std::string& path, std::uint64_t max_bytes) {
  return {ErrorCode::out_of_resources,
          path + ": larger than the limit of " + std::to_string(max_bytes) + " bytes"};
}

// What the file system claims, if it can know; the reading does not rely on it.
std::optional<std::uint64_t> size_of(const FileDescriptor& file) {
  struct stat info {};
  if (::fstat(file.get(), &info) != 0 || !S_ISREG(info.st_mode)) return std::nullopt;
  return static_cast<std::uint64_t>(info.st_size);
}

Result<Bytes> read_all(const FileDescriptor& file, const std::string& path,
                       std::uint64_t max_bytes) {
  const std::uint64_t expected = size_of(file).value_or(0);
  if (expected > max_bytes) return too_large(path, max_bytes);
  Bytes bytes(expected + 1);  // One more, so that the end is seen without growing.
  std::size_t size = 0;
  for (;;) {
    if (size == bytes.size()) bytes.resize(std::max(2 * size, kReadStep));
    const ssize_t got = ::read(file.get(), bytes.data() + size, bytes.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return file_error(path, "read", errno);
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
    if (size > max_bytes) return too_large(path, max_bytes);
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace

Result<Bytes> read_file(const std::string& path, std::uint64_t max_bytes) {
  const FileDescriptor file = open_descriptor(path, O_RDONLY);
  if (!file.valid()) return file_error(path, "open", errno);
  try {
    return read_all(file, path, max_bytes);
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  return file_error(path, "read", ENOMEM);
}

Result<RandomAccessFile> RandomAccessFile::open(const std::string& path) {
  FileDescriptor file = open_descriptor(path, O_RDONLY | O_NONBLOCK);
  if (!file.valid()) return file_error(path, "open", errno);
  struct stat info {};
  if (::fstat(file.get(), &info) != 0) return file_error(path, "open", errno);
  if (!S_ISREG(info.st_mode)) return runtime_error(path + ": is no regular file");
  return RandomAccessFile(path, std::move(file), static_cast<std::uint64_t>(info.st_size));
}

RandomAccessFile::RandomAccessFile(std::string path, FileDescriptor file, std::uint64_t size)
    : path_(std::move(path)), file_(std::move(file)), size_(size) {}

Status RandomAccessFile::read(std::uint64_t offset, std::span<std::uint8_t> out) const {
  while (!out.empty()) {
    const ssize_t got = ::pread(file_.get(), out.data(), out.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return file_error(path_, "read", errno);
    if (got == 0) return runtime_error(path_ + ": ends at byte " + std::to_string(offset));
    offset += static_cast<std::uint64_t>(got);
    out = out.subspan(static_cast<std::size_t>(got));
  }
  return {};
}

}  // namespace pmesh
