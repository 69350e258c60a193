#include "core/files/file_descriptor.h"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace pmesh {
namespace {

constexpr int kNewFileMode = 0666;  // Narrowed by the process's umask.

bool is_exhaustion(int error_number) {
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
    case ENOMEM:
    case EMFILE:
    case ENFILE:
      return true;
    default:
      return false;
  }
}

}  // namespace

void FileDescriptor::reset() {
  if (valid()) ::close(descriptor_);  // On Linux the descriptor is gone even after EINTR.
  descriptor_ = -1;
}

FileDescriptor open_descriptor(const std::string& path, int flags) {
  int descriptor = -1;
  do {
    descriptor = ::open(path.c_str(), flags | O_CLOEXEC, kNewFileMode);
  } while (descriptor < 0 && errno == EINTR);
  return FileDescriptor(descriptor);
}

Error file_error(const std::string& path, const std::string& verb, int error_number) {
  const ErrorCode code =
      is_exhaustion(error_number) ? ErrorCode::out_of_resources : ErrorCode::runtime;
  return {code, path + ": cannot " + verb + ": " + std::generic_category().message(error_number)};
}

}  // namespace pmesh
