// ChunkWriter and ChunkReader against each other.
#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/pm/chunk_reader.h"
#include "core/pm/chunk_writer.h"

namespace pmesh {
namespace {

// A decision of one of a few models, or raw bits.
struct Symbol {
  std::size_t model = 0;
  int raw_bits = 0;  // 0 for a decision
  std::uint32_t value = 0;
};

using Models = std::array<AdaptiveBit, 4>;

template <class Coder>
std::uint32_t code(Coder& coder, Models& models, const Symbol& symbol) {
  return symbol.raw_bits > 0 ? coder.raw(symbol.raw_bits, symbol.value)
                             : coder.bit(models[symbol.model], symbol.value != 0);
}

// Chances of 1 in 2, 5, 70 and 3000.
std::vector<Symbol> random_symbols(std::uint32_t seed, std::size_t count, bool decisions,
                                   bool raw_bits) {
  constexpr std::array<std::uint32_t, 4> kOneIn = {2, 5, 70, 3000};
  std::mt19937 random(seed);
  std::vector<Symbol> symbols;
  for (; count > 0; --count) {
    if (raw_bits && (!decisions || random() % 4 == 0)) {
      const int bits = static_cast<int>(1 + random() % 32);
      symbols.push_back({0, bits, static_cast<std::uint32_t>(random()) >> (32 - bits)});
    } else {
      const std::size_t model = random() % 4;
      symbols.push_back({model, 0, random() % kOneIn[model] == 0});
    }
  }
  return symbols;
}

ChunkWriter write(const std::vector<Symbol>& symbols) {
  ChunkWriter writer;
  Models models;
  for (const Symbol& symbol : symbols) code(writer, models, symbol);
  return writer;
}

void expect_read(ByteView bytes, const std::vector<Symbol>& symbols) {
  ChunkReader reader(bytes);
  Models models;
  for (const Symbol& symbol : symbols) ASSERT_EQ(code(reader, models, symbol), symbol.value);
  EXPECT_FALSE(reader.failed());
  EXPECT_TRUE(reader.at_end());
}

TEST(ChunkCoder, GivesBackDecisionsAndRawBitsInAnyMixture) {
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    const auto symbols = random_symbols(seed, seed * seed / 8, seed % 3 != 1, seed % 3 != 2);
    expect_read(write(symbols).finish(), symbols);
  }
}

TEST(ChunkCoder, GivesBackDecisionsBesideRawBitsOfEveryLength) {
  for (std::uint32_t seed = 0; seed < 400; ++seed) {
    const auto decisions = random_symbols(seed, seed / 100 * 15, true, false);
    for (int bits = 0; bits <= 96; ++bits) {
      std::vector<Symbol> raw_bits;
      std::mt19937 random(seed);
      for (int done = 0; done < bits; ++done) {  // zeros, ones or any
        const bool one = seed % 3 == 2 ? random() % 2 == 0 : seed % 3 == 1;
        raw_bits.push_back({0, 1, one});
      }
      for (const bool raw_first : {false, true}) {
        std::vector<Symbol> symbols = raw_first ? raw_bits : decisions;
        const std::vector<Symbol>& others = raw_first ? decisions : raw_bits;
        symbols.insert(symbols.end(), others.begin(), others.end());
        expect_read(write(symbols).finish(), symbols);
      }
    }
  }
}

TEST(ChunkCoder, TellsAheadHowLongTheChunkWillBeAtMost) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const ChunkWriter writer = write(random_symbols(seed, seed, true, true));
    const std::size_t bytes = ChunkWriter(writer).finish().size();
    EXPECT_LE(bytes, writer.byte_count());
    EXPECT_GE(bytes + 2, writer.byte_count());
  }
}

TEST(ChunkCoder, TakesLittleMoreThanItsDecisionsTell) {
  AdaptiveBit model;
  ChunkWriter writer;
  for (int n = 0; n < 80'000; ++n) writer.bit(model, n % 100 == 7);
  constexpr double kEntropy = 80'000 * 0.0808 / 8;
  EXPECT_LT(static_cast<double>(writer.byte_count()), 1.25 * kEntropy);
}

// The coder's interval, followed to find decisions that carry.
struct Interval {
  AdaptiveBit model;
  std::uint64_t low = 0, range = (std::uint64_t{1} << 48) - 1;
  bool carried = false;

  std::uint64_t bound() const { return (range >> 16) * model.one(); }
  bool ends_above_carry() const { return (low + range) >> 48 != 0; }
  void follow(bool one) {
    const std::uint64_t part = bound();
    low += one ? 0 : part;
    range = one ? part : range - part;
    model.update(one);
    carried = low >> 48 != 0;
    if (range >> 32 != 0) return;
    low = (low & 0xFFFF'FFFF) << 16;
    range <<= 16;
  }
};

// Any decisions until the next carry lies inside the interval, then such as keep it there, then
// such as go above it.
std::vector<Symbol> symbols_that_carry(int kept_waiting) {
  std::vector<Symbol> symbols;
  Interval interval;
  const auto add = [&](bool one) {
    symbols.push_back({0, 0, one});
    interval.follow(one);
  };
  std::mt19937 random(1);
  do {
    add(random() % 2 == 0);
  } while (interval.carried || !interval.ends_above_carry());
  while (kept_waiting-- > 0) add((interval.low + interval.bound()) >> 48 != 0);
  while (!interval.carried) add(false);
  return symbols;
}

TEST(ChunkCoder, ACarryRunsThroughManyUnits) {
  const auto symbols = symbols_that_carry(400);
  const Bytes bytes = write(symbols).finish();
  const Bytes zeros(12);
  EXPECT_NE(std::search(bytes.begin(), bytes.end(), zeros.begin(), zeros.end()), bytes.end());
  expect_read(bytes, symbols);
}

// Reads all symbols, whatever comes of them.
ChunkReader read(ByteView bytes, const std::vector<Symbol>& symbols) {
  ChunkReader reader(bytes);
  Models models;
  for (const Symbol& symbol : symbols) code(reader, models, symbol);
  return reader;
}

bool is_whole(const ChunkReader& reader) { return !reader.failed() && reader.at_end(); }

TEST(ChunkCoder, EveryCutOfTheRawBitsIsNoticed) {
  const auto symbols = random_symbols(7, 200, false, true);
  const Bytes whole = write(symbols).finish();
  for (std::size_t n = 0; n < whole.size(); ++n) {
    EXPECT_FALSE(is_whole(read(ByteView(whole).last(n), symbols))) << n;
  }
}

TEST(ChunkCoder, EveryCutOfTheDecisionsIsNoticedButForBytesThatAreLookedAheadAt) {
  const auto symbols = random_symbols(7, 200, true, false);
  const Bytes whole = write(symbols).finish();
  for (std::size_t n = 0; n + 2 < whole.size(); ++n) {
    EXPECT_FALSE(is_whole(read(ByteView(whole).first(n), symbols))) << n;
  }
}

TEST(ChunkCoder, AChunkOfNothingLacksRawBitsAndAnEnd) {
  ChunkReader reader({});
  EXPECT_FALSE(reader.at_end());
  EXPECT_EQ(reader.raw(32), 0u);
  EXPECT_TRUE(reader.failed());
}

TEST(ChunkCoder, DecisionsLookNoFurtherAheadThanSixBytes) {
  const Bytes one_byte(1);
  ChunkReader reader(one_byte);
  AdaptiveBit model;
  EXPECT_TRUE(reader.at_end());
  for (int n = 0; n < 200; ++n) reader.bit(model);
  EXPECT_FALSE(reader.failed());  // ever likelier ones need no unit
  EXPECT_TRUE(reader.at_end());
  for (int n = 0; n < 40; ++n) {
    AdaptiveBit even;
    reader.bit(even);
  }
  EXPECT_TRUE(reader.failed());
  EXPECT_FALSE(reader.at_end());
}

TEST(ChunkCoder, RefusesACodeThatIsNotBelowTheRange) {
  EXPECT_TRUE(ChunkReader(Bytes(8, 0xFF)).failed());
  EXPECT_FALSE(ChunkReader(Bytes{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFE}).failed());
}

TEST(ChunkCoder, AllowsZerosBetweenTheStreamsAndNothingElse) {
  const auto symbols = random_symbols(11, 100, true, true);
  Bytes filled = write(symbols).finish(1000);
  ASSERT_EQ(filled.size(), 1000u);
  expect_read(filled, symbols);
  filled[500] = 1;
  ChunkReader reader(filled);
  Models models;
  for (const Symbol& symbol : symbols) code(reader, models, symbol);
  EXPECT_FALSE(reader.at_end());
}

TEST(ChunkCoder, RefusesBytesBetweenTheStreams) {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    const auto symbols = random_symbols(seed, 1 + seed, true, false);
    Bytes bytes = write(symbols).finish();
    bytes.insert(bytes.end(), 6, 0x40);  // in place of those that a decoder looks ahead at
    EXPECT_FALSE(is_whole(read(bytes, symbols))) << seed;
  }
}

TEST(ChunkCoder, SeesThatSomethingIsLeftOver) {
  auto symbols = random_symbols(13, 100, false, true);
  symbols.push_back({0, 20, 0xFFFFF});
  const Bytes bytes = write(symbols).finish();
  ChunkReader reader(bytes);
  Models models;
  for (std::size_t i = 0; i + 1 < symbols.size(); ++i) code(reader, models, symbols[i]);
  EXPECT_FALSE(reader.at_end());
}

}  // namespace
}  // namespace pmesh
