// Runs a fuzz target without libFuzzer: over every file of the folders (or the files) named on the
// command line, and over every proper prefix of each file of at most kMaxPrefixedBytes. Each input
// lies in a block of exactly its size, so that AddressSanitizer sees a read one byte too far.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxPrefixedBytes = 2048;

std::vector<fs::path> files_below(const fs::path& path) {
  if (fs::is_regular_file(path)) return {path};
  std::vector<fs::path> files;
  if (!fs::is_directory(path)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(path)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string contents(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void run(const std::string& bytes, std::size_t size) {
  const auto block = std::make_unique<std::uint8_t[]>(size);
  std::copy_n(bytes.begin(), size, block.get());
  LLVMFuzzerTestOneInput(block.get(), size);
}

std::size_t replay(const fs::path& path) {
  const std::string bytes = contents(path);
  std::size_t runs = 1;
  run(bytes, bytes.size());
  if (bytes.size() > kMaxPrefixedBytes) return runs;
  for (std::size_t size = 0; size < bytes.size(); ++size, ++runs) run(bytes, size);
  return runs;
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t files = 0;
  std::size_t runs = 0;
  for (int i = 1; i < argc; ++i) {
    for (const fs::path& path : files_below(argv[i])) {
      runs += replay(path);
      ++files;
    }
  }
  std::printf("%zu seeds, %zu runs\n", files, runs);
  return files == 0 ? 1 : 0;  // a replay of nothing is a mistake
}
