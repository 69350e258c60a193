#include "core/pm/format.h"

#include <functional>

#include <gtest/gtest.h>

namespace pmesh {
namespace {

FileIndex small_index() {
  FileIndex index;
  FileHeader& h = index.header;
  h.base_vertices = 4;
  h.base_faces = 4;
  h.base_bytes = 100;
  h.lattice = {{1, 2, 3}, 0.5, 12};
  h.box_high = {100, 200, 300};
  h.vertices = 10;
  h.faces = 16;
  h.metric = "melod";
  h.parameters = "lambda=10";
  h.unit = "mm";
  index.chunks.resize(2);
  index.chunks[0].bytes = 50;
  index.chunks[0].vertices = 6;
  index.chunks[0].faces = 8;
  index.chunks[1].bytes = 70;
  index.chunks[1].vertices = 10;
  index.chunks[1].faces = 16;
  return index;
}

std::string error_of(const std::function<void(FileIndex&)>& change) {
  FileIndex index = small_index();
  change(index);
  const auto parsed = parse_prologue(write_prologue(index));
  return parsed ? "none" : parsed.error().message;
}

TEST(Prologue, ComesBackAsItWasWritten) {
  FileIndex index = small_index();
  index.header.content_hash.fill(7);
  index.header.has_borders = true;
  index.header.has_relocations = true;
  const Bytes bytes = write_prologue(index);
  const auto parsed = parse_prologue(bytes);
  ASSERT_TRUE(parsed.ok() && parsed->has_value());
  const FileIndex& back = **parsed;
  EXPECT_EQ(back.header.metric, "melod");
  EXPECT_EQ(back.header.parameters, "lambda=10");
  EXPECT_EQ(back.header.unit, "mm");
  EXPECT_EQ(back.header.lattice, index.header.lattice);
  EXPECT_EQ(back.header.box_high, index.header.box_high);
  EXPECT_EQ(back.header.content_hash, index.header.content_hash);
  EXPECT_TRUE(back.header.has_borders);
  EXPECT_TRUE(back.header.has_relocations);
  EXPECT_EQ(back.chunks[1].offset, bytes.size() + 150);
  EXPECT_EQ(back.header.file_bytes, bytes.size() + 220);
  FileIndex again = back;
  EXPECT_EQ(write_prologue(again), bytes);
}

TEST(Prologue, IsPackedAndSmall) {
  FileIndex index = small_index();
  EXPECT_EQ(write_prologue(index).size(), 168 + 3 + 5 + 9 + 2 + 2 * 36);
}

TEST(Prologue, WantsMoreAsLongAsItIsCut) {
  FileIndex index = small_index();
  const Bytes bytes = write_prologue(index);
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
    const auto parsed = parse_prologue(cut);
    ASSERT_TRUE(parsed.ok()) << n << ": " << parsed.error().message;
    ASSERT_FALSE(parsed->has_value()) << n;
  }
}

TEST(Prologue, RefusesEveryFlippedBit) {
  FileIndex index = small_index();
  const Bytes bytes = write_prologue(index);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    const std::size_t byte = bit / 8;
    if (byte >= kContentHashOffset && byte < kContentHashOffset + sizeof(ContentHash)) continue;
    Bytes flipped = bytes;
    flipped[byte] ^= static_cast<std::uint8_t>(1 << bit % 8);
    const auto parsed = parse_prologue(flipped);
    // A larger count or size may also make it wait for more; it never parses.
    ASSERT_TRUE(!parsed.ok() || !parsed->has_value()) << "bit " << bit;
  }
}

TEST(Prologue, RefusesWhatIsNoPmFile) {
  const auto parsed = parse_prologue(as_bytes("ply"));
  ASSERT_FALSE(parsed.ok());
  EXPECT_EQ(parsed.error().message, "not a PM file");
}

TEST(Prologue, RefusesAVersionItDoesNotKnow) {
  FileIndex index = small_index();
  Bytes bytes = write_prologue(index);
  bytes[8] = 9;
  EXPECT_EQ(parse_prologue(bytes).error().message, "PM format version 9 is not known");
}

TEST(Prologue, RefusesCountsThatCannotBe) {
  EXPECT_EQ(error_of([](FileIndex&) {}), "none");
  EXPECT_EQ(error_of([](FileIndex& i) { i.header.base_faces = 0; }),
            "header: impossible counts of the base mesh");
  EXPECT_EQ(error_of([](FileIndex& i) { i.header.base_vertices = 13; }),
            "header: impossible counts of the base mesh");
  EXPECT_EQ(error_of([](FileIndex& i) { i.header.vertices = 11; }),
            "index: its rows do not add up to the header's totals");
  EXPECT_EQ(error_of([](FileIndex& i) { i.chunks[1].vertices = i.chunks[0].vertices; }),
            "index row 1: counts do not grow");
  EXPECT_EQ(error_of([](FileIndex& i) { i.chunks[0].faces = 7; }),
            "index row 0: impossible counts");
  EXPECT_EQ(error_of([](FileIndex& i) { i.chunks[0].bytes = 0; }), "index row 0: no bytes");
}

TEST(Prologue, AllowsOneFaceSplitsOnlyWithBorders) {
  const auto odd = [](FileIndex& i) {
    i.chunks[0].faces = 7;
    i.chunks[1].faces = i.header.faces = 15;
  };
  EXPECT_EQ(error_of(odd), "index row 0: impossible counts");
  EXPECT_EQ(error_of([&](FileIndex& i) {
              odd(i);
              i.header.has_borders = true;
            }),
            "none");
}

TEST(Prologue, RefusesCountsThatItsBytesCannotHold) {
  const std::string bomb = error_of([](FileIndex& i) {
    i.header.base_faces = 1'000'000;
    i.header.base_vertices = 500'000;
  });
  EXPECT_EQ(bomb, "header: the base's bytes do not fit its faces");
  EXPECT_EQ(error_of([](FileIndex& i) {
              i.chunks[1].vertices = i.header.vertices = 1006;
              i.chunks[1].faces = i.header.faces = 2008;
            }),
            "index row 1: impossible counts");
}

TEST(Prologue, RefusesMoreBytesThanItsCountsCanNeed) {
  const std::string misfit = "header: the base's bytes do not fit its faces";
  EXPECT_EQ(error_of([](FileIndex& i) { i.header.base_bytes = 0; }), misfit);
  EXPECT_EQ(error_of([](FileIndex& i) { i.header.base_bytes = std::uint64_t{1} << 40; }), misfit);
  EXPECT_EQ(error_of([](FileIndex& i) { i.header.base_bytes = 64 * 4 + 4097; }), misfit);
  EXPECT_EQ(error_of([](FileIndex& i) { i.chunks[0].bytes = 64 + 2 * 64 + 1; }),
            "index row 0: impossible counts");
}

TEST(Prologue, AllowsLongerSplitsOnlyWithRelocations) {
  const auto error_with_bytes = [](std::uint32_t bytes, bool relocations) {
    return error_of([=](FileIndex& i) {
      i.chunks[0].bytes = bytes;
      i.header.has_relocations = relocations;
    });
  };
  EXPECT_EQ(error_with_bytes(64 + 2 * 64, false), "none");
  EXPECT_EQ(error_with_bytes(64 + 2 * 64 + 1, false), "index row 0: impossible counts");
  EXPECT_EQ(error_with_bytes(64 + 2 * 96, true), "none");
  EXPECT_EQ(error_with_bytes(64 + 2 * 96 + 1, true), "index row 0: impossible counts");
}

TEST(Prologue, RefusesStringsThatCannotBePrinted) {
  const std::string unprintable = "header: a string is not printable ASCII";
  EXPECT_EQ(error_of([](FileIndex& i) { i.header.metric = "\xFF\xFE"; }), unprintable);
  EXPECT_EQ(error_of([](FileIndex& i) { i.header.unit = "\x1B[2J"; }), unprintable);
}

TEST(Prologue, RefusesAnImpossibleLattice) {
  EXPECT_EQ(error_of([](FileIndex& i) { i.header.lattice.step = 0; }),
            "header: the lattice's step is not positive");
  EXPECT_EQ(error_of([](FileIndex& i) { i.header.lattice.bits = 31; }),
            "header: lattice bits are out of range");
  EXPECT_EQ(error_of([](FileIndex& i) { i.header.lattice.origin.x = 1.0 / 0.0; }),
            "header: the lattice is not finite");
  EXPECT_EQ(error_of([](FileIndex& i) { i.header.box_high.y = 4096; }),
            "header: the bounding box is off the lattice");
}

TEST(Prologue, HoldsTheCallersLimits) {
  FileIndex index = small_index();
  DecodeLimits limits;
  limits.max_faces = 15;
  const auto parsed = parse_prologue(write_prologue(index), limits);
  ASSERT_FALSE(parsed.ok());
  EXPECT_EQ(parsed.error().code, ErrorCode::out_of_resources);
}

}  // namespace
}  // namespace pmesh
