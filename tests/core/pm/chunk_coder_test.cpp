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

TEST(ChunkCoder, TellsTheChunksLengthAhead) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    const ChunkWriter writer = write(random_symbols(seed, 10 * seed, true, true));
    EXPECT_EQ(ChunkWriter(writer).finish().size(), writer.byte_count());
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

TEST(ChunkCoder, EveryCutOfOneStreamIsNoticed) {
  for (const bool raw_bits : {false, true}) {
    const auto symbols = random_symbols(7, 200, !raw_bits, raw_bits);
    const Bytes whole = write(symbols).finish();
    for (std::size_t n = 0; n < whole.size(); ++n) {
      // The raw bits stand at the chunk's end, the decisions at its start.
      const ByteView view(whole);
      ChunkReader reader(raw_bits ? view.last(n) : view.first(n));
      Models models;
      for (const Symbol& symbol : symbols) code(reader, models, symbol);
      EXPECT_TRUE(reader.failed()) << n;
    }
  }
}

TEST(ChunkCoder, BytesThatAreNotThereReadAsZeros) {
  ChunkReader reader({});
  EXPECT_TRUE(reader.failed());
  EXPECT_EQ(reader.raw(32), 0u);
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
