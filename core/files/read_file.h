// Whole files and exact spans of files, read.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/files/file_descriptor.h"

namespace pmesh {

inline constexpr std::uint64_t kNoByteLimit = std::numeric_limits<std::uint64_t>::max();

/// All bytes of the file (or pipe) at `path`. Errors name the path: runtime, or out_of_resources
/// if there are more than `max_bytes` or memory is short.
Result<Bytes> read_file(const std::string& path, std::uint64_t max_bytes = kNoByteLimit);

/// A regular file open for reads at any offset. Threads: const members may be called at the same
/// time. A file replaced by rename stays readable as it was; one changed in place does not.
class RandomAccessFile {
 public:
  static Result<RandomAccessFile> open(const std::string& path);

  /// Fills `out` with the bytes from `offset` on. Fails if the file ends before.
  Status read(std::uint64_t offset, std::span<std::uint8_t> out) const;

  /// Bytes in the file when it was opened.
  std::uint64_t size() const { return size_; }
  const std::string& path() const { return path_; }
  /// For sendfile(2) and fstat(2); valid as long as this object is.
  int descriptor() const { return file_.get(); }

 private:
  RandomAccessFile(std::string path, FileDescriptor file, std::uint64_t size);

  std::string path_;
  FileDescriptor file_;
  std::uint64_t size_ = 0;
};

}  // namespace pmesh
