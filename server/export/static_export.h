// The served meshes as plain files that any web host or bucket can hand out under the server's URLs
// (docs/operation.md, "Plain hosts"):
//   OUT/catalog                    the answer of /catalog
//   OUT/{id}/index.json            the answer of /{id}
//   OUT/{id}/{hash}.pmesh          the file
//   OUT/{id}/{hash}/c/{n}          chunk n of it
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/pm/format.h"

namespace pmesh {

struct ExportedMesh {
  std::string id;
  FileIndex index;
  bool is_new = false;  ///< Its file was not there yet.
};

struct ExportReport {
  std::vector<ExportedMesh> meshes;            ///< By id.
  std::map<std::string, std::string> skipped;  ///< Paths of the directory, and why.
  /// What an earlier export left, relative to the output, and no mesh of today needs.
  std::vector<std::string> stale;
  std::uint64_t files_written = 0;
  std::uint64_t bytes_written = 0;
};

/// Exports every mesh that a server of `directory` would serve. Every section of a file is checked
/// against its digest as it is copied; a file that does not hold is skipped. Each file appears
/// whole or not at all, the catalogue last, so that a host never names what is not there. A hashed
/// file that is there already stays as it is, and so does other text that would not change.
///
/// Stale files go only if `delete_stale`; those of a mesh that was skipped are not stale. Nothing
/// else in `output` is touched.
///
/// Fails (usage) if `directory` is none or `output` lies in it, (runtime, out_of_resources) if the
/// directory cannot be read to its end or the output not written. Threads: any, one at a time for
/// an output.
Result<ExportReport> export_static(const std::string& directory, const std::string& output,
                                   bool delete_stale);

}  // namespace pmesh
