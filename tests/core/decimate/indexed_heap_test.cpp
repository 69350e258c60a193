#include "core/decimate/indexed_heap.h"

#include <algorithm>
#include <map>
#include <random>

#include <gtest/gtest.h>

namespace pmesh {
namespace {

using Heap = IndexedHeap<VertexId>;

constexpr std::uint32_t kVertices = 300;

// What a heap must do, the slow way.
class NaiveHeap {
 public:
  void set(VertexId v, double key) { keys_[v] = key; }
  void erase(VertexId v) { keys_.erase(v); }
  bool empty() const { return keys_.empty(); }

  VertexId pop() {
    const auto least = std::min_element(keys_.begin(), keys_.end(), [](auto& a, auto& b) {
      return std::pair(a.second, tie_rank(a.first)) < std::pair(b.second, tie_rank(b.first));
    });
    const VertexId v = least->first;
    keys_.erase(least);
    return v;
  }

 private:
  std::map<VertexId, double> keys_;
};

TEST(IndexedHeap, DoesWhatANaiveHeapDoes) {
  std::mt19937 random(7);
  Heap heap;
  heap.build({}, kVertices);
  NaiveHeap naive;
  for (int step = 0; step < 20'000; ++step) {
    const VertexId v(static_cast<std::uint32_t>(random() % kVertices));
    const std::uint32_t action = random() % 8;
    if (action < 5) {
      const double key = double(random() % 50);  // many ties
      heap.set(v, key);
      naive.set(v, key);
    } else if (action < 6) {
      heap.erase(v);
      naive.erase(v);
    } else if (!heap.empty()) {
      EXPECT_EQ(heap.pop().element, naive.pop());
    }
    ASSERT_EQ(heap.empty(), naive.empty());
  }
}

TEST(IndexedHeap, BuildOrdersWhatItIsGiven) {
  std::mt19937 random(8);
  std::vector<Heap::Entry> entries;
  for (std::uint32_t v = 0; v < kVertices; ++v)
    entries.push_back({double(random() % 9), VertexId(v)});
  Heap heap;
  heap.build(entries, kVertices);
  std::sort(entries.begin(), entries.end());
  for (const Heap::Entry& entry : entries) EXPECT_EQ(heap.pop().element, entry.element);
  EXPECT_TRUE(heap.empty());
}

TEST(IndexedHeap, BuildTakesSubsets) {
  std::vector<Heap::Entry> entries;
  for (std::uint32_t v = 10; v <= 70; v += 10) entries.push_back({100.0 - v, VertexId(v)});
  Heap heap;
  heap.build(entries, kVertices);
  heap.erase(VertexId(8));  // not in it
  heap.set(VertexId(8), 35);
  EXPECT_EQ(heap.pop().element, VertexId(70));
  EXPECT_EQ(heap.pop().element, VertexId(8));
  EXPECT_EQ(heap.pop().element, VertexId(60));
  EXPECT_EQ(heap.size(), 5u);
}

TEST(IndexedHeap, TieRanksAreDistinct) {
  std::vector<std::uint32_t> ranks;
  for (std::uint32_t v = 0; v < 100'000; ++v) ranks.push_back(tie_rank(VertexId(v)));
  std::sort(ranks.begin(), ranks.end());
  EXPECT_EQ(std::adjacent_find(ranks.begin(), ranks.end()), ranks.end());
}

}  // namespace
}  // namespace pmesh
