// write_glbs MESH FOLDER [OFFSET]: imports a mesh, moves it by OFFSET along each axis, and writes
// it at the default precision as FOLDER/plain.glb and FOLDER/draco.glb. Prints the lattice's step
// and where its first point lies, as a JSON object.
#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "core/files/atomic_file.h"
#include "core/io/export.h"
#include "core/io/import.h"
#include "core/precompute/quantise.h"

namespace pmesh {
namespace {

Status write_glbs(const std::string& source, const std::string& folder, double offset) {
  Result<ImportedMesh> imported = import_mesh(source);
  if (!imported) return imported.error();
  IndexedMesh& mesh = imported->mesh;
  for (Vec3d& p : mesh.positions) p += {offset, offset, offset};
  const Result<Lattice> lattice = choose_lattice(mesh, mesh.positions, {});
  if (!lattice) return lattice.error();
  const LatticeMesh level{quantise(mesh.positions, *lattice), mesh.triangles};
  for (const auto& [name, format] : {std::pair("/plain.glb", ExportFormat::glb),
                                     std::pair("/draco.glb", ExportFormat::glb_draco)}) {
    const Result<Bytes> bytes = format_mesh(format, level, *lattice);
    if (!bytes) return bytes.error();
    if (Status written = write_file(folder + name, *bytes, Overwrite::yes); !written)
      return written;
  }
  const Vec3d origin = lattice->origin;
  std::printf("{\"step\": %.17g, \"origin\": [%.17g, %.17g, %.17g]}\n", lattice->step, origin.x,
              origin.y, origin.z);
  return {};
}

}  // namespace
}  // namespace pmesh

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const auto written = pmesh::write_glbs(argv[1], argv[2], argc > 3 ? std::atof(argv[3]) : 0);
  if (!written) std::cerr << written.error().message << '\n';
  return written ? 0 : 1;
}
