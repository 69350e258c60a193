// A small made-up index for tests of what is computed from one.
#pragma once

#include "core/pm/format.h"
#include "tests/fixtures/measured.h"

namespace pmesh::testing {

/// A base of 10 faces, 7 vertices and 100 bytes after 50 bytes of prologue, then three chunks of
/// 20, 30 and 40 bytes that add 5, 10 and 20 vertices. No borders: every split adds two faces.
inline FileIndex sample_index() {
  FileIndex index;
  index.prologue_bytes = 50;
  index.header.base_bytes = 100;
  index.header.base_faces = 10;
  index.header.base_vertices = 7;
  index.header.lattice = {.origin = {1, 2, 3}, .step = 0.5, .bits = 12};
  index.header.box_high = {4, 2, 0};
  index.header.content_hash = {0xAB, 0xCD};
  index.chunks = {{.offset = 150, .bytes = 20, .vertices = 12, .faces = 20},
                  {.offset = 170, .bytes = 30, .vertices = 22, .faces = 40},
                  {.offset = 200, .bytes = 40, .vertices = 42, .faces = 80}};
  index.header.vertices = 42;
  index.header.faces = 80;
  index.header.file_bytes = 240;
  return index;
}

/// The same with borders: the second chunk's 10 splits add only 16 faces, so 4 are border splits.
inline FileIndex sample_index_with_borders() {
  FileIndex index = sample_index();
  index.header.has_borders = true;
  index.chunks[1].faces = 36;
  index.chunks[2].faces = 76;
  index.header.faces = 76;
  return index;
}

/// The first, but of the second chunk's growth 4 vertices and 8 faces are new components.
inline FileIndex sample_index_with_arrivals() {
  FileIndex index = sample_index();
  index.header.has_arrivals = true;
  index.chunks[1].arrivals = {.vertices = 4, .faces = 8};
  return index;
}

/// The first with measured errors 4, 1 and 2: the third chunk makes it worse. Its diagonal is
/// 0.5 * length(4, 2, 0) = sqrt(5).
inline FileIndex sample_index_with_errors() {
  FileIndex index = sample_index();
  set_errors(index, {4, 1, 2});
  return index;
}

}  // namespace pmesh::testing
