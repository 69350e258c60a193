#include "server/store/mesh_file.h"

#include "core/pm/digest.h"

namespace pmesh {
namespace {

FileStamp stamp_from(const struct stat& status) {
  return {.device = status.st_dev,
          .inode = status.st_ino,
          .bytes = status.st_size,
          .modified_ns = status.st_mtim.tv_sec * 1'000'000'000 + status.st_mtim.tv_nsec};
}

std::optional<FileStamp> stamp_of_descriptor(int descriptor) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return {};
  return stamp_from(status);
}

}  // namespace

std::optional<FileStamp> stamp_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return {};
  return stamp_from(status);
}

Result<MeshPtr> MeshFile::open(std::string id, const std::string& path) {
  const auto stamp = stamp_of(path);
  if (!stamp) return runtime_error(path + ": not a regular file");
  Result<PmFile> file = PmFile::open(path);
  if (!file) return file.error();
  if (!file->complete()) {
    return Error{ErrorCode::verification,
                 path + ": incomplete: " +
                     std::to_string(file->index().header.file_bytes - file->bytes_on_disk()) +
                     " bytes are missing"};
  }
  auto mesh = std::make_shared<const MeshFile>(std::move(id), std::move(*file), *stamp);
  if (!mesh->intact()) return runtime_error(path + ": changed while it was opened");
  return mesh;
}

Status MeshFile::check_sections() const {
  const auto check = [&](std::uint64_t begin, std::uint64_t end, const SectionDigest& digest,
                         const std::string& name) -> Status {
    const Result<Bytes> section = file_.read(begin, end);
    if (!section) return section.error();
    if (digest_section(*section) == digest) return {};
    return Error{ErrorCode::verification, file_.file().path() + ": " + name + ": altered"};
  };
  const FileHeader& header = index().header;
  Status checked = check(index().prologue_bytes, index().base_end(), header.base_digest, "base");
  for (std::size_t c = 0; checked && c < index().chunks.size(); ++c) {
    const ChunkRow& row = index().chunks[c];
    checked = check(row.offset, row.end(), row.digest, "chunk " + std::to_string(c));
  }
  return checked;
}

bool MeshFile::intact() const { return stamp_of_descriptor(descriptor()) == stamp_; }

bool MeshFile::recently_intact() const {
  constexpr std::chrono::milliseconds kInterval{10};
  if (file_look_.is_due(kInterval) && !intact()) broken_ = true;
  return !broken_;
}

}  // namespace pmesh
