// A file that appears whole or not at all.
//
// The bytes go to `.NAME.partial` beside the target NAME. commit() makes them durable and renames
// them over the target, so that at every moment (kill -9 and power cuts included) the target is
// absent, the old file, or the complete new one. The temporary's name is fixed, so a killed run
// leaves at most one behind, which the next write to the same target reuses and so removes.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/files/file_descriptor.h"

namespace pmesh {

enum class Overwrite : std::uint8_t {
  no,   ///< An existing target is an error, both when creating and when committing.
  yes,  ///< An existing target is replaced by commit().
};

/// Errors name the target: runtime, or out_of_resources if the disk or a quota is full. Threads:
/// one object belongs to one thread; two objects may be used at the same time.
class AtomicFile {
 public:
  /// Opens the temporary file and locks it until this object is destroyed. Fails if another
  /// AtomicFile, in any process, is writing the same target, or if the target exists and is not a
  /// regular file. A target that is a symbolic link is replaced, not followed.
  static Result<AtomicFile> create(const std::string& path, Overwrite overwrite);

  AtomicFile(AtomicFile&&) noexcept = default;
  AtomicFile& operator=(AtomicFile&&) = delete;
  /// Without a successful commit(), removes the temporary file; the target stays as it was.
  ~AtomicFile();

  /// Appends `bytes`. Not buffered: give it large pieces. After an error only destroy the object.
  Status write(ByteView bytes);

  /// Flushes the file to disk, renames it to the target and flushes the directory. Call it once,
  /// last. If only the last of these fails ("cannot make its new name durable"), the new file is in
  /// place, but a power cut may bring the old one back.
  Status commit();

 private:
  AtomicFile(std::string path, std::string temporary, FileDescriptor file, Overwrite overwrite);
  Status rename_to_target();

  std::string path_;
  std::string temporary_;
  FileDescriptor file_;  // Invalid once committed or moved from.
  Overwrite overwrite_;
};

/// create(), write() and commit() in one call.
Status write_file(const std::string& path, ByteView bytes, Overwrite overwrite);

}  // namespace pmesh
