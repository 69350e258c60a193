// make_sample FILE.pmesh SEED: writes a PM file of about 5 MB that a server serves, though its base
// and chunks decode to nothing: large files in no time.
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "tests/server/sample_file.h"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: make_sample FILE.pmesh SEED\n");
    return 2;
  }
  const auto seed = static_cast<std::uint32_t>(std::strtoul(argv[2], nullptr, 10));
  const auto sample = pmesh::testing::make_sample(
      {4'096, 65'536, 100'000, 262'144, 262'144, 1'000'000, 1'500'000, 2'000'000}, seed,
      {8, 7, 6, 5, 4, 3, 2, 1});
  std::ofstream file(argv[1], std::ios::binary);
  file << sample.text();
  return file.flush() ? 0 : 1;
}
