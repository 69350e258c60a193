#include "server/export/static_export.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "core/files/atomic_file.h"
#include "core/files/file_descriptor.h"
#include "core/files/read_file.h"
#include "core/pm/digest.h"
#include "core/pm/pm_file.h"
#include "protocol/catalogue_json.h"
#include "protocol/mesh_id.h"
#include "protocol/routes.h"
#include "server/export/stale_files.h"
#include "server/store/mesh_scan.h"

namespace pmesh {

namespace fs = std::filesystem;

namespace {

/// The bytes [begin, end) of a file, if they have the digest that its index promises.
Result<Bytes> checked_section(const PmFile& file, std::uint64_t begin, std::uint64_t end,
                              const SectionDigest& digest, const std::string& name) {
  auto section = file.read(begin, end);
  if (section && digest_section(*section) != digest) return damaged(name + ": altered");
  return section;
}

Status make_directories(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  return error ? Status(file_error(path, "make the directory", error.value())) : Status();
}

bool is_file_of_size(const std::string& path, std::uint64_t bytes) {
  std::error_code error;
  return fs::is_regular_file(path, error) && fs::file_size(path, error) == bytes && !error;
}

class Export {
 public:
  Export(std::string root, std::string output)
      : root_(std::move(root)), output_(std::move(output)) {}

  Status run() {
    MeshScan scan = scan_meshes(root_);
    if (!scan.fault.empty()) return runtime_error(root_ + ": cannot be read: " + scan.fault);
    report.skipped = std::move(scan.left_out);
    ids_ = std::move(scan.ids);
    std::sort(ids_.begin(), ids_.end());
    for (const std::string& id : ids_) {
      if (Status done = export_mesh(id); !done) return done;
    }
    return write_names();
  }

  /// Every id of the directory, also of meshes that were skipped.
  const std::vector<std::string>& ids() const { return ids_; }

  ExportReport report;

 private:
  Status export_mesh(const std::string& id) {
    const std::string path = root_ + "/" + path_of_mesh_id(id);
    const Result<PmFile> file = open(path);
    if (!file) return skip(path, file.error());
    const FileHeader& header = file->index().header;
    const std::string target = output_ + file_target(id, header.content_hash);
    const bool is_new = !is_file_of_size(target, header.file_bytes);
    if (is_new) {
      const auto fault = copy(*file, id, target);
      if (!fault) return fault.error();
      if (*fault) return skip(path, **fault);
    }
    report.meshes.push_back({id, file->index(), is_new});
    return {};
  }

  Result<PmFile> open(const std::string& path) const {
    if (Status place = check_place(root_, path); !place) return place.error();
    auto file = PmFile::open(path);
    if (file && !file->complete()) return damaged(path + ": incomplete");
    return file;
  }

  Status skip(const std::string& path, const Error& why) {
    const bool has_path = why.message.starts_with(path + ": ");
    report.skipped[path] = has_path ? why.message.substr(path.size() + 2) : why.message;
    return {};
  }

  /// Copies the file and its chunks, the whole file last. Gives what is wrong with the source, if
  /// something is; fails if the output cannot be written.
  Result<std::optional<Error>> copy(const PmFile& file, const std::string& id,
                                    const std::string& target) {
    const FileIndex& index = file.index();
    const fs::path chunk0 = output_ + chunk_target(id, index.header.content_hash, 0);
    if (Status made = make_directories(chunk0.parent_path().string()); !made) return made.error();
    auto whole = AtomicFile::create(target, Overwrite::yes);
    if (!whole) return whole.error();

    const auto prologue = file.read(0, index.prologue_bytes);
    if (!prologue) return std::optional(prologue.error());
    if (Status done = whole->write(*prologue); !done) return done.error();
    const auto base = checked_section(file, index.prologue_bytes, index.base_end(),
                                      index.header.base_digest, "base");
    if (!base) return std::optional(base.error());
    if (Status done = whole->write(*base); !done) return done.error();
    for (std::size_t c = 0; c < index.chunks.size(); ++c) {
      const ChunkRow& row = index.chunks[c];
      const auto chunk =
          checked_section(file, row.offset, row.end(), row.digest, "chunk " + std::to_string(c));
      if (!chunk) return std::optional(chunk.error());
      if (Status done = whole->write(*chunk); !done) return done.error();
      const std::string name = output_ + chunk_target(id, index.header.content_hash, c);
      if (Status done = write(name, *chunk); !done) return done.error();
    }
    if (Status done = whole->commit(); !done) return done.error();
    count(index.header.file_bytes);
    return std::optional<Error>();
  }

  /// What the server says of the meshes: each mesh's own first, the catalogue last.
  Status write_names() {
    std::vector<CatalogueEntry> entries;
    for (const ExportedMesh& mesh : report.meshes) {
      entries.push_back({mesh.id, &mesh.index});
      const std::string path = output_ + "/" + mesh.id + "/index.json";
      if (Status done = write_changed(path, mesh_info_json(entries.back())); !done) return done;
    }
    if (Status made = make_directories(output_); !made) return made;
    return write_changed(output_ + "/catalog", catalogue_json(entries));
  }

  Status write_changed(const std::string& path, const std::string& text) {
    const Result<Bytes> before = read_file(path, text.size());
    if (before && std::ranges::equal(*before, as_bytes(text))) return {};
    return write(path, as_bytes(text));
  }

  Status write(const std::string& path, ByteView bytes) {
    Status done = write_file(path, bytes, Overwrite::yes);
    if (done) count(bytes.size());
    return done;
  }

  void count(std::uint64_t bytes) {
    ++report.files_written;
    report.bytes_written += bytes;
  }

  const std::string root_;    // canonical
  const std::string output_;  // absolute
  std::vector<std::string> ids_;
};

}  // namespace

Result<ExportReport> export_static(const std::string& directory, const std::string& output,
                                   bool delete_stale) {
  std::error_code error;
  const std::string root = fs::canonical(directory, error).string();
  if (error || !fs::is_directory(root, error)) {
    return Error{ErrorCode::usage, directory + ": not a directory that can be read"};
  }
  const std::string target = fs::weakly_canonical(fs::absolute(output), error).string();
  if (error) return file_error(output, "resolve", error.value());
  if ((target + "/").starts_with(root == "/" ? root : root + "/")) {
    return Error{ErrorCode::usage, output + ": lies in the directory that is exported"};
  }
  Export meshes(root, target);
  if (Status done = meshes.run(); !done) return done.error();
  meshes.report.stale = stale_files(target, meshes.report.meshes, meshes.ids());
  if (delete_stale) {
    if (Status done = delete_files(target, meshes.report.stale); !done) return done.error();
  }
  return std::move(meshes.report);
}

}  // namespace pmesh
