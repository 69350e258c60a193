// Mutations of PM files, from blind ones that a checksum stops to ones that carry true checksums.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "core/base/bytes.h"
#include "core/pm/format.h"

namespace pmesh {

struct Mutation {
  Bytes file;
  bool verify_checksums = true;
};

class Mutator {
 public:
  /// `files` must be whole PM files.
  explicit Mutator(std::vector<Bytes> files);

  /// A pure function of its arguments and the files.
  Mutation mutate(std::uint64_t seed, std::uint64_t number) const;

 private:
  using Random = std::mt19937_64;

  void scramble(Bytes& bytes, Random& random) const;
  Bytes scramble_section(std::size_t which, Random& random) const;
  Bytes change_claims(std::size_t which, Random& random) const;

  std::vector<Bytes> files_;
  std::vector<FileIndex> indices_;  // by file
};

}  // namespace pmesh
