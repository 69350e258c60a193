// Real PM files, small ones, opened as the server opens them.
#pragma once

#include <string>

#include "server/store/mesh_file.h"
#include "tests/fixtures/pm_files.h"
#include "tests/fixtures/shapes.h"
#include "tests/fixtures/temporary_directory.h"

namespace pmesh::testing {

/// A PM file of about 2,500 faces without borders.
inline EncodedShape closed_shape() {
  return encode_shape("sphere", shapes::bumped(shapes::icosphere(3), 0.05));
}

/// A PM file of 2,000 faces whose chunks have border splits.
inline EncodedShape open_shape() {
  return encode_shape("grid", shapes::bumped(shapes::grid(40, 25), 0.01));
}

class OpenedMesh {
 public:
  explicit OpenedMesh(const EncodedShape& shape)
      : path_(directory_.write("mesh.pmesh", shape.file)),
        mesh_(MeshFile::open(shape.name, path_).value()) {}

  const std::string& path() const { return path_; }
  const MeshPtr& mesh() const { return mesh_; }
  const FileIndex& index() const { return mesh_->index(); }

 private:
  TemporaryDirectory directory_;
  std::string path_;
  MeshPtr mesh_;
};

}  // namespace pmesh::testing
