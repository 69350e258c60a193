#include "core/pm/digest.h"

#include <algorithm>
#include <array>
#include <cassert>

#include <openssl/evp.h>

namespace pmesh {
namespace {

std::array<std::uint8_t, 32> sha256(ByteView bytes) {
  std::array<std::uint8_t, 32> digest{};
  [[maybe_unused]] const int done =
      EVP_Digest(bytes.data(), bytes.size(), digest.data(), nullptr, EVP_sha256(), nullptr);
  assert(done == 1);
  return digest;
}

template <class Short>
Short first_bytes(const std::array<std::uint8_t, 32>& digest) {
  Short result{};
  std::copy_n(digest.begin(), result.size(), result.begin());
  return result;
}

}  // namespace

ContentHash hash_prologue(ByteView prologue) {
  assert(prologue.size() >= kContentHashOffset + sizeof(ContentHash));
  Bytes copy(prologue.begin(), prologue.end());
  std::fill_n(copy.begin() + kContentHashOffset, sizeof(ContentHash), std::uint8_t{0});
  return first_bytes<ContentHash>(sha256(copy));
}

Bytes write_hashed_prologue(FileIndex& index) {
  index.header.content_hash = hash_prologue(write_prologue(index));
  return write_prologue(index);
}

SectionDigest digest_section(ByteView section) {
  return first_bytes<SectionDigest>(sha256(section));
}

}  // namespace pmesh
