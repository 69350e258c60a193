// What the batched engine keeps of its elements: their keys, and which of them have changed since
// these were found. Private to core/decimate.
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/decimate/batch_keys.h"
#include "core/mesh/half_edge_mesh.h"

namespace pmesh {

/// By element. A key says what an element costs, and orders the log; a factor of at least 1 how
/// much worse than that it codes. At first, and whenever it has changed, an element waits for
/// put().
template <class ElementId>
class BatchElements {
 public:
  explicit BatchElements(std::uint32_t slots)
      : keys_(slots, 0), factors_(slots, 1), is_changed_(slots, 1) {}

  /// Of a changed element the key that it inherits. kNoKey: it is no candidate.
  float key(ElementId e) const { return std::abs(keys_[e.value]); }
  float weighed_key(ElementId e) const { return keys_[e.value] * factors_[e.value]; }
  bool is_changed(ElementId e) const { return is_changed_[e.value] != 0; }

  void put(ElementId e, double key, double factor) {
    put_key(e, key);
    factors_[e.value] = static_cast<float>(factor);
    is_changed_[e.value] = 0;
  }
  void put_key(ElementId e, double key) { keys_[e.value] = batch_key(key); }

  void change(ElementId e, float key) {
    is_changed_[e.value] = 1;
    keys_[e.value] = key;
  }

  /// The same from several threads, and several times for one element: the greatest key is
  /// inherited, if any (`inherits`). Until put(), only key() and is_changed() may be asked for.
  template <bool inherits>
  void change_by_one_of_many(ElementId e, float key) {
    std::atomic_ref(is_changed_[e.value]).store(1, std::memory_order_relaxed);
    if constexpr (inherits) {
      const std::atomic_ref inherited(keys_[e.value]);  // a sign tells it from the element's own
      float found = inherited.load(std::memory_order_relaxed);
      while ((!std::signbit(found) || -found < key) &&
             !inherited.compare_exchange_weak(found, -key, std::memory_order_relaxed)) {
      }
    }
  }

  /// Follows vertices to compact ids.
  void renumber(const CompactIds& ids) {
    close_up(keys_, ids.vertices);
    close_up(factors_, ids.vertices);
    close_up(is_changed_, ids.vertices);
  }

 private:
  std::vector<float> keys_, factors_;
  std::vector<std::uint8_t> is_changed_;
};

}  // namespace pmesh
