// An indexed 4-ary heap of vertices, edges or faces, least key first, equal keys by tie_rank(): a
// total order, so that what is popped never depends on the history of the heap.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/ids.h"

namespace pmesh {

/// Orders elements of equal keys. On a flat surface all keys are zero; taken in the order of their
/// ids, vertices would be swept into a few of enormous valence. Distinct for distinct ids.
template <class Tag>
constexpr std::uint32_t tie_rank(Id<Tag> id) {
  return id.value * 0x9E37'79B1u;
}

/// 16 bytes an element and 4 bytes an id. Keys must not be NaN.
template <class ElementId>
class IndexedHeap {
 public:
  struct Entry {
    double key = 0;
    ElementId element;

    friend bool operator<(const Entry& a, const Entry& b) {
      return a.key < b.key || (a.key == b.key && tie_rank(a.element) < tie_rank(b.element));
    }
  };

  /// Replaces the contents by `entries`, of ids below `id_count`, each once. O(n).
  void build(std::vector<Entry> entries, std::uint32_t id_count) {
    entries_ = std::move(entries);
    slots_.assign(id_count, kNoIndex);
    for (std::uint32_t slot = 0; slot < size(); ++slot) slot_of(entries_[slot].element) = slot;
    for (std::uint32_t slot = size() / kArity + 1; slot-- > 0;) {
      if (slot < size()) sift_down(slot, entries_[slot]);
    }
  }

  bool empty() const { return entries_.empty(); }
  std::uint32_t size() const { return static_cast<std::uint32_t>(entries_.size()); }
  const Entry& top() const { return entries_.front(); }

  Entry pop() {
    const Entry least = top();
    erase(least.element);
    return least;
  }

  bool contains(ElementId element) const { return slots_[element.value] != kNoIndex; }

  /// Ask for what set() and erase() read to be brought into the caches: first the element's slot,
  /// then, once that is there, its entry and those next to it in the heap.
  void prefetch_slot(ElementId element) const { __builtin_prefetch(&slots_[element.value]); }
  void prefetch_entry(ElementId element) const {
    const std::uint32_t slot = slots_[element.value];
    if (slot == kNoIndex) return;
    const std::size_t first_child = std::size_t{slot} * kArity + 1;
    for (const std::size_t near :
         {std::size_t{slot}, std::size_t{slot} / kArity, first_child, first_child + kArity - 1}) {
      if (near < entries_.size()) __builtin_prefetch(entries_.data() + near);
    }
  }

  /// Inserts `element`, or changes its key.
  void set(ElementId element, double key) {
    std::uint32_t slot = slot_of(element);
    if (slot == kNoIndex) {
      slot = size();
      entries_.emplace_back();
    }
    place(slot, {key, element});
  }

  /// Takes `element` out, if it is in.
  void erase(ElementId element) {
    const std::uint32_t slot = slot_of(element);
    if (slot == kNoIndex) return;
    slot_of(element) = kNoIndex;
    const Entry last = entries_.back();
    entries_.pop_back();
    if (slot < size()) place(slot, last);
  }

 private:
  static constexpr std::uint32_t kArity = 4;

  std::uint32_t& slot_of(ElementId element) { return slots_[element.value]; }

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
    slot_of(entry.element) = slot;
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
  std::vector<std::uint32_t> slots_;  // by id; kNoIndex: not in the heap
};

}  // namespace pmesh
