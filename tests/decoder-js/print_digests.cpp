// print_digests FILE: what decode.js prints of it.
#include <cstdio>
#include <fstream>
#include <iterator>

#include "core/pm/base_codec.h"
#include "core/pm/stream_decoder.h"
#include "tests/fixtures/mesh_digest.h"

namespace pmesh {
namespace {

Bytes read(const char* path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

Status print(const Bytes& file) {
  const auto index = parse_prologue(file);
  if (!index) return index.error();
  if (!index->has_value()) return bad_input("too short");
  StreamDecoder decoder(decode_base);
  for (std::size_t chunks = 0; chunks <= (*index)->chunks.size(); ++chunks) {
    const std::size_t end = (*index)->prefix_bytes(chunks);
    if (end > file.size()) return bad_input("too short");
    Status fed =
        decoder.feed(ByteView(file).subspan(decoder.fed_bytes(), end - decoder.fed_bytes()));
    if (!fed) return fed;
    const RefinableMesh& mesh = decoder.mesh();
    std::printf("%u %u %08x\n", mesh.vertex_count(), mesh.face_count(), digest(mesh.snapshot()));
  }
  return {};
}

}  // namespace
}  // namespace pmesh

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const pmesh::Status printed = pmesh::print(pmesh::read(argv[1]));
  if (!printed) std::fprintf(stderr, "print_digests: %s\n", printed.error().message.c_str());
  return printed.ok() ? 0 : 1;
}
