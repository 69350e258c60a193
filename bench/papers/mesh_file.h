// Mesh files, for bench/papers' programs.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

#include "core/io/clean.h"
#include "core/io/import.h"

namespace pmesh::bench {

/// Ends the program with `message` on standard error.
[[noreturn]] inline void fail(const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  std::exit(1);
}

/// The mesh of that file, cleaned as `pmesh precompute` does it. Fails if there is none.
inline IndexedMesh load_clean(const std::string& path) {
  Result<ImportedMesh> imported = import_mesh(path);
  if (!imported) fail(imported.error().message);
  IndexedMesh mesh = clean(std::move(*imported)).mesh;
  if (mesh.triangles.empty()) fail(path + ": no triangle");
  return mesh;
}

}  // namespace pmesh::bench
