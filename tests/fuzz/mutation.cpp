#include "tests/fuzz/mutation.h"

#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>

#include "core/base/crc32c.h"

namespace pmesh {
namespace {

std::size_t below(std::mt19937_64& random, std::size_t bound) { return random() % bound; }

Bytes::iterator at(Bytes& bytes, std::size_t place) {
  return bytes.begin() + static_cast<std::ptrdiff_t>(place);
}

std::uint8_t interesting_byte(std::mt19937_64& random) {
  constexpr std::uint8_t kBytes[] = {0, 1, 0x7F, 0x80, 0xFE, 0xFF};
  return random() % 2 == 0 ? kBytes[below(random, 6)] : static_cast<std::uint8_t>(random());
}

// A range of at most 64 bytes, or now and then of any length.
struct Range {
  std::size_t begin, end;
};
Range random_range(const Bytes& bytes, std::mt19937_64& random) {
  const std::size_t begin = below(random, bytes.size());
  const std::size_t most = random() % 8 == 0 ? bytes.size() : 64;
  return {begin, std::min(bytes.size(), begin + 1 + below(random, most))};
}

// The CRCs of base, chunks and prologue, made true again if the file can still be parsed.
void reseal(Bytes& file) {
  auto parsed = parse_prologue(file, {.verify_checksums = false});
  if (!parsed || !parsed->has_value()) return;
  FileIndex& index = **parsed;
  const auto crc_of = [&](std::uint64_t begin, std::uint64_t end) {
    end = std::min<std::uint64_t>(end, file.size());
    return crc32c(ByteView(file).subspan(std::min(begin, end), end - std::min(begin, end)));
  };
  index.header.base_crc = crc_of(index.prologue_bytes, index.base_end());
  for (ChunkRow& row : index.chunks) row.crc = crc_of(row.offset, row.end());
  if (prologue_size(index) != index.prologue_bytes) return;
  const Bytes prologue = write_prologue(index);
  std::copy(prologue.begin(), prologue.end(), file.begin());
}

}  // namespace

Mutator::Mutator(std::vector<Bytes> files) : files_(std::move(files)) {
  for (const Bytes& file : files_) indices_.push_back(**parse_prologue(file));
}

Mutation Mutator::mutate(std::uint64_t seed, std::uint64_t number) const {
  Random random(seed * 0x9E37'79B9'7F4A'7C15 + number);
  const std::size_t which = below(random, files_.size());
  Mutation mutation;
  switch (random() % 8) {
    case 0:
      mutation.file = files_[which];
      scramble(mutation.file, random);
      break;
    case 1:
      mutation.file = files_[which];
      scramble(mutation.file, random);
      mutation.verify_checksums = false;
      break;
    case 2:
      mutation.file = files_[which];
      scramble(mutation.file, random);
      reseal(mutation.file);
      break;
    case 3:
      mutation.file = change_claims(which, random);
      break;
    default:
      mutation.file = scramble_section(which, random);
  }
  return mutation;
}

// One to four flips, cuts, insertions or splices.
void Mutator::scramble(Bytes& bytes, Random& random) const {
  for (std::uint64_t edits = 1 + random() % 4; edits > 0 && !bytes.empty(); --edits) {
    const Range range = random_range(bytes, random);
    const Bytes& other = files_[below(random, files_.size())];
    const Range taken = random_range(other, random);
    switch (random() % 8) {
      case 0:
      case 1:
        bytes[range.begin] ^= static_cast<std::uint8_t>(1u << random() % 8);
        break;
      case 2:
        bytes[range.begin] = interesting_byte(random);
        break;
      case 3:
        bytes.resize(range.begin);
        break;
      case 4:
        bytes.erase(at(bytes, range.begin), at(bytes, range.end));
        break;
      case 5:
        std::fill(at(bytes, range.begin), at(bytes, range.end), interesting_byte(random));
        break;
      case 6:
        bytes.insert(at(bytes, range.begin), range.end - range.begin, interesting_byte(random));
        break;
      default:
        bytes.insert(at(bytes, range.begin),
                     other.begin() + static_cast<std::ptrdiff_t>(taken.begin),
                     other.begin() + static_cast<std::ptrdiff_t>(taken.end));
    }
  }
}

// Base or one chunk scrambled behind a header and an index that agree with it.
Bytes Mutator::scramble_section(std::size_t which, Random& random) const {
  const Bytes& file = files_[which];
  FileIndex index = indices_[which];
  const std::size_t chunks = index.chunks.size();
  const bool is_base = chunks == 0 || random() % 4 == 0;
  const std::size_t c = is_base ? 0 : below(random, chunks);
  const auto begin =
      static_cast<std::ptrdiff_t>(is_base ? index.prologue_bytes : index.chunks[c].offset);
  const auto end = static_cast<std::ptrdiff_t>(is_base ? index.base_end() : index.chunks[c].end());
  Bytes section(file.begin() + begin, file.begin() + end);
  scramble(section, random);
  if (section.empty()) section.push_back(0);
  if (is_base) {
    index.header.base_bytes = section.size();
    index.header.base_crc = crc32c(section);
  } else {
    index.chunks[c].bytes = static_cast<std::uint32_t>(section.size());
    index.chunks[c].crc = crc32c(section);
  }
  Bytes mutated = write_prologue(index);
  mutated.insert(mutated.end(), file.begin() + indices_[which].prologue_bytes,
                 file.begin() + begin);
  mutated.insert(mutated.end(), section.begin(), section.end());
  mutated.insert(mutated.end(), file.begin() + end, file.end());
  return mutated;
}

// Numbers and flags of header and index a little, or wildly, off, over the sections as they are.
Bytes Mutator::change_claims(std::size_t which, Random& random) const {
  const Bytes& file = files_[which];
  FileIndex index = indices_[which];
  FileHeader& header = index.header;
  const auto off = [&](auto& number) {
    using Number = std::remove_reference_t<decltype(number)>;
    number = random() % 8 == 0 ? static_cast<Number>(random() >> random() % 64)
                               : static_cast<Number>(number + 4 - random() % 9);
  };
  const std::size_t chunks = index.chunks.size();
  ChunkRow none;
  ChunkRow& row = chunks == 0 ? none : index.chunks[below(random, chunks)];
  const std::array counts = {&header.base_vertices,  &header.base_faces, &row.vertices, &row.faces,
                             &row.arrivals.vertices, &row.arrivals.faces};
  const std::array flags = {&header.has_borders, &header.has_relocations, &header.has_arrivals};
  switch (random() % 8) {
    case 0:
      off(header.lattice.bits);
      break;
    case 1:
      off(row.bytes);
      break;
    case 2: {
      bool& flag = *flags[below(random, flags.size())];
      flag = !flag;
      break;
    }
    default:
      off(*counts[below(random, counts.size())]);
  }
  header.vertices = index.vertices_after(chunks);
  header.faces = index.faces_after(chunks);
  Bytes mutated = write_prologue(index);
  mutated.insert(mutated.end(), file.begin() + indices_[which].prologue_bytes, file.end());
  return mutated;
}

}  // namespace pmesh
