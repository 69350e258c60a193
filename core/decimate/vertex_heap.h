// An indexed 4-ary heap of vertices, least key first, equal keys by tie_rank(): a total order, so
// that what is popped never depends on the history of the heap.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/ids.h"

namespace pmesh {

/// Orders vertices of equal keys. On a flat surface all keys are zero; taken in the order of their
/// ids, vertices would be swept into a few of enormous valence. Distinct for distinct vertices.
constexpr std::uint32_t tie_rank(VertexId v) { return v.value * 0x9E37'79B1u; }

/// 20 bytes a vertex. Keys must not be NaN.
class VertexHeap {
 public:
  struct Entry {
    double key = 0;
    VertexId vertex;

    friend bool operator<(const Entry& a, const Entry& b) {
      return a.key < b.key || (a.key == b.key && tie_rank(a.vertex) < tie_rank(b.vertex));
    }
  };

  /// Replaces the contents by `entries`, of vertices below `vertex_count`, each once. O(n).
  void build(std::vector<Entry> entries, std::uint32_t vertex_count) {
    entries_ = std::move(entries);
    slots_.assign(vertex_count, kNoIndex);
    for (std::uint32_t slot = 0; slot < size(); ++slot) slots_[vertex_at(slot)] = slot;
    for (std::uint32_t slot = size() / kArity + 1; slot-- > 0;) {
      if (slot < size()) sift_down(slot, entries_[slot]);
    }
  }

  bool empty() const { return entries_.empty(); }
  std::uint32_t size() const { return static_cast<std::uint32_t>(entries_.size()); }
  const Entry& top() const { return entries_.front(); }

  Entry pop() {
    const Entry least = top();
    erase(least.vertex);
    return least;
  }

  /// Inserts `vertex`, or changes its key.
  void set(VertexId vertex, double key) {
    std::uint32_t slot = slots_[vertex.value];
    if (slot == kNoIndex) {
      slot = size();
      entries_.emplace_back();
    }
    place(slot, {key, vertex});
  }

  /// Takes `vertex` out, if it is in.
  void erase(VertexId vertex) {
    const std::uint32_t slot = slots_[vertex.value];
    if (slot == kNoIndex) return;
    slots_[vertex.value] = kNoIndex;
    const Entry last = entries_.back();
    entries_.pop_back();
    if (slot < size()) place(slot, last);
  }

 private:
  static constexpr std::uint32_t kArity = 4;

  std::uint32_t& vertex_slot(VertexId v) { return slots_[v.value]; }
  std::uint32_t vertex_at(std::uint32_t slot) const { return entries_[slot].vertex.value; }

  // Puts `entry` into the heap, whose free slot is `slot`.
  void place(std::uint32_t slot, Entry entry) {
    if (slot > 0 && entry < entries_[(slot - 1) / kArity]) {
      sift_up(slot, entry);
    } else {
      sift_down(slot, entry);
    }
  }

  void store(std::uint32_t slot, const Entry& entry) {
    entries_[slot] = entry;
    vertex_slot(entry.vertex) = slot;
  }

  void sift_up(std::uint32_t slot, Entry entry) {
    while (slot > 0) {
      const std::uint32_t parent = (slot - 1) / kArity;
      if (!(entry < entries_[parent])) break;
      store(slot, entries_[parent]);
      slot = parent;
    }
    store(slot, entry);
  }

  void sift_down(std::uint32_t slot, Entry entry) {
    while (true) {
      const std::size_t first = std::size_t{slot} * kArity + 1;
      const std::size_t end = std::min(first + kArity, entries_.size());
      if (first >= end) break;
      std::size_t least = first;
      for (std::size_t child = first + 1; child < end; ++child) {
        if (entries_[child] < entries_[least]) least = child;
      }
      if (!(entries_[least] < entry)) break;
      store(slot, entries_[least]);
      slot = static_cast<std::uint32_t>(least);
    }
    store(slot, entry);
  }

  std::vector<Entry> entries_;
  std::vector<std::uint32_t> slots_;  // by vertex; kNoIndex: not in the heap
};

}  // namespace pmesh
