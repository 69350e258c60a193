// What the classes of core/files share: an owned descriptor, and system errors as values.
#pragma once

#include <string>
#include <utility>

#include "core/base/result.h"

namespace pmesh {

/// Owns an open file descriptor; closes it on destruction.
class FileDescriptor {
 public:
  FileDescriptor() = default;
  explicit FileDescriptor(int descriptor) : descriptor_(descriptor) {}
  FileDescriptor(FileDescriptor&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~FileDescriptor() { reset(); }

  bool valid() const { return descriptor_ >= 0; }
  int get() const { return descriptor_; }
  void reset();

 private:
  int descriptor_ = -1;
};

/// open(2), always with O_CLOEXEC, again after EINTR; invalid, with errno set, if it fails.
FileDescriptor open_descriptor(const std::string& path, int flags);

/// "PATH: cannot VERB: what the system says"; out_of_resources if the disk, a quota, the memory or
/// the table of descriptors is full, else runtime.
Error file_error(const std::string& path, const std::string& verb, int error_number);

}  // namespace pmesh
