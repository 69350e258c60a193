#include "core/files/atomic_file.h"

#include <cassert>
#include <cerrno>
#include <cstdio>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pmesh {
namespace {

constexpr char kMakeNameDurable[] = "make its new name durable";

std::string directory_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "./" : path.substr(0, slash + 1);
}

std::string temporary_name(const std::string& path) {
  const std::size_t name = path.rfind('/') + 1;  // npos + 1 is 0.
  return path.substr(0, name) + "." + path.substr(name) + ".partial";
}

Error exists_error(const std::string& path) { return runtime_error(path + ": the file exists"); }

Status check_target(const std::string& path, Overwrite overwrite) {
  if (path.empty() || path.back() == '/') return runtime_error("'" + path + "' names no file");
  struct stat target {};
  if (::stat(path.c_str(), &target) != 0) {
    if (errno == ENOENT) return {};
    return file_error(path, "create", errno);
  }
  if (!S_ISREG(target.st_mode)) return runtime_error(path + ": exists and is no regular file");
  if (overwrite == Overwrite::no) return exists_error(path);
  return {};
}

// Whether `name` still names the open file: the writer that held the lock before may have renamed
// or removed it.
bool still_names(const std::string& name, const FileDescriptor& file) {
  struct stat named {};
  struct stat open {};
  return ::lstat(name.c_str(), &named) == 0 && ::fstat(file.get(), &open) == 0 &&
         named.st_dev == open.st_dev && named.st_ino == open.st_ino;
}

Result<FileDescriptor> open_locked(const std::string& path, const std::string& temporary) {
  for (;;) {
    FileDescriptor file = open_descriptor(temporary, O_WRONLY | O_CREAT | O_NOFOLLOW | O_NONBLOCK);
    if (!file.valid()) return file_error(path, "create " + temporary, errno);
    if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0) {
      if (errno == EINTR) continue;
      if (errno == EWOULDBLOCK) return runtime_error(path + ": another process is writing it");
      return file_error(path, "lock " + temporary, errno);
    }
    if (still_names(temporary, file)) return file;
  }
}

Status flush(const FileDescriptor& file, const std::string& path, const char* verb) {
  while (::fsync(file.get()) != 0) {
    if (errno == EINVAL) return {};  // A file system without fsync for this kind of file.
    if (errno != EINTR) return file_error(path, verb, errno);
  }
  return {};
}

}  // namespace

Result<AtomicFile> AtomicFile::create(const std::string& path, Overwrite overwrite) {
  if (Status checked = check_target(path, overwrite); !checked.ok()) return checked.error();
  std::string temporary = temporary_name(path);
  Result<FileDescriptor> file = open_locked(path, temporary);
  if (!file.ok()) return file.error();
  AtomicFile created(path, std::move(temporary), std::move(*file), overwrite);
  if (::ftruncate(created.file_.get(), 0) != 0) return file_error(path, "truncate", errno);
  return created;
}

AtomicFile::AtomicFile(std::string path, std::string temporary, FileDescriptor file,
                       Overwrite overwrite)
    : path_(std::move(path)),
      temporary_(std::move(temporary)),
      file_(std::move(file)),
      overwrite_(overwrite) {}

AtomicFile::~AtomicFile() {
  if (file_.valid()) ::unlink(temporary_.c_str());  // While locked: it is still ours.
}

Status AtomicFile::write(ByteView bytes) {
  assert(file_.valid());
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_.get(), bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      return file_error(path_, "write", errno);
    }
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return {};
}

Status AtomicFile::commit() {
  assert(file_.valid());
  if (Status flushed = flush(file_, path_, "flush"); !flushed.ok()) return flushed;
  if (Status renamed = rename_to_target(); !renamed.ok()) return renamed;
  file_.reset();
  const FileDescriptor directory = open_descriptor(directory_of(path_), O_RDONLY | O_DIRECTORY);
  if (!directory.valid()) return file_error(path_, kMakeNameDurable, errno);
  return flush(directory, path_, kMakeNameDurable);
}

Status AtomicFile::rename_to_target() {
  if (overwrite_ == Overwrite::no) {
    if (::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, path_.c_str(), RENAME_NOREPLACE) == 0) {
      return {};
    }
    if (errno == EEXIST) return exists_error(path_);
    // Not every file system knows the flag; then a look just before must do.
    if (errno != EINVAL && errno != ENOSYS) return file_error(path_, "replace", errno);
    if (Status checked = check_target(path_, overwrite_); !checked.ok()) return checked;
  }
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) {
    return file_error(path_, "replace", errno);
  }
  return {};
}

Status write_file(const std::string& path, ByteView bytes, Overwrite overwrite) {
  Result<AtomicFile> file = AtomicFile::create(path, overwrite);
  if (!file.ok()) return file.error();
  if (Status written = file->write(bytes); !written.ok()) return written;
  return file->commit();
}

}  // namespace pmesh
