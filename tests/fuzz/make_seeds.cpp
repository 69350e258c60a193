// Writes the seeds that are made by the codec itself: make_seeds FOLDER, where FOLDER is
// tests/fuzz/seeds. To be run, and the seeds committed, whenever the bitstream changes.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/fixtures/pm_files.h"
#include "tests/fixtures/random_chunks.h"
#include "tests/fixtures/shapes.h"

namespace {

using namespace pmesh;
namespace fs = std::filesystem;

void write(const fs::path& folder, std::string name, const Bytes& seed) {
  fs::create_directories(folder);
  name.erase(std::remove(name.begin(), name.end(), ','), name.end());
  std::replace(name.begin(), name.end(), ' ', '_');
  std::ofstream file(folder / name, std::ios::binary);
  file.write(reinterpret_cast<const char*>(seed.data()), static_cast<std::streamsize>(seed.size()));
  std::printf("%s %zu\n", name.c_str(), seed.size());
}

// As fuzz_stream_decoder reads it.
void write_file_seed(const fs::path& folder, const std::string& name, const Bytes& file) {
  constexpr std::uint8_t kCuts = 7;
  Bytes seed = {kCuts};
  seed.insert(seed.end(), file.begin(), file.end());
  write(folder, name, seed);
}
void write_file_seed(const fs::path& folder, const EncodedShape& shape) {
  write_file_seed(folder, shape.name, shape.file);
}

// As fuzz_split_decoder reads it.
void write_chunk_seed(const fs::path& folder, const SplitBase& base, std::uint8_t which) {
  RandomChunks chunks(base, which);
  chunks.add_batch(24);
  chunks.add_batch(2);
  const RandomChunks::Chunk first = chunks.finish_chunk();
  for (int batch = 0; batch < 4; ++batch) chunks.add_batch(4);
  const RandomChunks::Chunk second = chunks.finish_chunk();
  Bytes seed;
  ByteWriter writer(seed);
  writer.put(which);
  writer.put(static_cast<std::uint16_t>(first.splits));
  writer.put(static_cast<std::uint16_t>(first.bytes.size()));
  writer.put(static_cast<std::uint16_t>(second.splits));
  writer.put(ByteView(first.bytes));
  writer.put(ByteView(second.bytes));
  write(folder, base.name, seed);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_seeds FOLDER\n");
    return 2;
  }
  using namespace shapes;
  const fs::path files = fs::path(argv[1]) / "stream_decoder";
  write_file_seed(files, encode_shape("tetrahedron", tetrahedron()));
  write_file_seed(files, encode_shape("genus3", genus(3)));
  write_file_seed(files, encode_shape("ears", grid_with_ears(6)));
  write_file_seed(files, encode_shape("hub", hub(100)));
  write_file_seed(files, encode_shape("components", components(12)));
  write_file_seed(files, encode_shape("two_chunks", bumped(icosphere(4), 0.05)));
  write_file_seed(files, encode_relocating_shape("relocations", grid_with_ears(4)));
  write_file_seed(files, encode_relocating_shape("relocating_sphere", icosphere(2)));
  write_file_seed(files, encode_relocating_shape("relocating_components", components(12)));
  write_file_seed(files, "arrivals", file_with_arrivals());
  const std::vector<SplitBase> bases = split_bases();
  for (std::size_t i = 0; i < bases.size(); ++i) {
    write_chunk_seed(fs::path(argv[1]) / "split_decoder", bases[i], static_cast<std::uint8_t>(i));
  }
  return 0;
}
