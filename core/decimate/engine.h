// The exact decimation engine, greedy by a heap: queue, commit, stop rule and progress around a
// kind of candidate (half_edge_candidates.h, edge_candidates.h, triangle_candidates.h), which
// brings the metric and judges what is legal. Private to core/decimate; the interface is
// decimate.h.
#pragma once

#include <algorithm>
#include <concepts>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/decimate/course.h"
#include "core/decimate/decimate.h"
#include "core/decimate/indexed_heap.h"
#include "core/decimate/legality.h"
#include "core/decimate/metric.h"
#include "core/decimate/working_mesh.h"
#include "core/parallel/for_blocks.h"

namespace pmesh {

/// What the engine asks of a kind of candidate. Elements (vertices, edges or faces) are queued by
/// their keys; one without a candidate has the key kRefused.
template <class C>
concept EngineCandidates = requires(C& candidates, const C& const_candidates,
                                    typename C::ElementId element, typename C::Scratch& scratch,
                                    double popped) {
  /// Half-edge collapses that one collapse() makes.
  { C::kCollapsesPerStep } -> std::convertible_to<std::uint32_t>;
  /// What one thread needs to evaluate an element.
  { scratch.mark } -> std::convertible_to<PhaseMark>;
  /// Ids of elements are below slots(); about candidate_guess() of them are candidates.
  { const_candidates.slots() } -> std::same_as<std::uint32_t>;
  { const_candidates.candidate_guess() } -> std::same_as<std::uint32_t>;
  /// The key of an element; `popped` is the key last popped, 0 at first.
  { candidates.evaluate(element, popped, scratch) } -> std::same_as<double>;
  /// The key of an element that was popped with the key `popped` and not collapsed.
  { candidates.evaluate_legal(element, popped, scratch) } -> std::same_as<double>;
  /// Is told, for what it is worth, which element will probably be popped next.
  { candidates.expect(element) } -> std::same_as<void>;
  /// Collapses a popped element; false if that is illegal.
  { candidates.collapse(element, popped, scratch) } -> std::same_as<bool>;
  /// After a collapse: elements that are no more, those to evaluate, and those to evaluate if they
  /// are not in the queue.
  { const_candidates.gone() } -> std::same_as<std::span<const typename C::ElementId>>;
  { const_candidates.changed() } -> std::same_as<std::span<const typename C::ElementId>>;
  { const_candidates.touched() } -> std::same_as<std::span<const typename C::ElementId>>;
  /// The keys of changed(), in its order.
  { candidates.evaluate_changed(popped, scratch) } -> std::same_as<std::span<const double>>;
  /// Gives up the next test, if there is one left.
  { candidates.relax() } -> std::same_as<std::optional<Relaxation>>;
};

template <EngineCandidates Candidates>
class Engine {
 public:
  Engine(WorkingMesh& work, Candidates& candidates, const DecimateOptions& options)
      : candidates_(candidates), options_(options), mark_{options.phase}, course_(work, options) {
    scratch_.mark = mark_;
  }

  DecimationReport run() {
    evaluate_all();
    collapse_all();
    course_.run_relaxed(candidates_, [&] {
      popped_ = 0;
      evaluate_all();
      collapse_all();
    });
    return course_.report();
  }

 private:
  using ElementId = typename Candidates::ElementId;
  using Heap = IndexedHeap<ElementId>;
  using Scratch = typename Candidates::Scratch;

  // A block of elements at a time, so that no key is kept for an element without a candidate.
  void evaluate_all() {
    mark_.enter(DecimationPhase::evaluate_all);
    constexpr std::uint32_t kBlock = 1 << 18;
    const std::uint32_t count = candidates_.slots();
    std::vector<typename Heap::Entry> entries;
    entries.reserve(candidates_.candidate_guess());
    std::vector<double> keys(std::min(count, kBlock));
    for (std::uint32_t first = 0; first < count; first += kBlock) {
      const std::uint32_t length = std::min(kBlock, count - first);
      evaluate_block(first, length, keys);
      for (std::uint32_t i = 0; i < length; ++i) {
        if (keys[i] < kRefused) entries.push_back({keys[i], ElementId(first + i)});
      }
    }
    heap_.build(std::move(entries), count);
  }

  void evaluate_block(std::uint32_t first, std::uint32_t length, std::vector<double>& keys) {
    for_blocks(length, options_.threads, [&](std::uint32_t begin, std::uint32_t end) {
      Scratch scratch;
      for (std::uint32_t i = begin; i < end; ++i) {
        keys[i] = candidates_.evaluate(ElementId(first + i), popped_, scratch);
      }
    });
  }

  void collapse_all() {
    while (!course_.is_done() && !heap_.empty()) {
      mark_.enter(DecimationPhase::heap);
      const typename Heap::Entry next = heap_.pop();
      popped_ = next.key;
      if (!heap_.empty()) candidates_.expect(heap_.top().element);
      if (candidates_.collapse(next.element, popped_, scratch_)) {
        update_queue();
      } else {
        put(next.element, candidates_.evaluate_legal(next.element, popped_, scratch_));
      }
      if (course_.collapses() % kProgressStride == 0) course_.show_progress();
    }
  }

  // After a collapse: takes out the elements that are gone, gives those that have changed their
  // new place, and one to those that were touched if they have none.
  void update_queue() {
    mark_.enter(DecimationPhase::heap);
    for (const ElementId element : candidates_.gone()) heap_.erase(element);
    const std::span<const ElementId> changed = candidates_.changed();
    for (const ElementId element : changed) heap_.prefetch_slot(element);
    const std::span<const double> keys = candidates_.evaluate_changed(popped_, scratch_);
    mark_.enter(DecimationPhase::heap);
    for (const ElementId element : changed) heap_.prefetch_entry(element);
    for (std::size_t i = 0; i < changed.size(); ++i) put(changed[i], keys[i]);
    for (const ElementId element : candidates_.touched()) {
      if (heap_.contains(element)) continue;
      put(element, candidates_.evaluate(element, popped_, scratch_));
    }
  }

  // Gives `element` its place in the queue, or none if it has no candidate.
  void put(ElementId element, double key) {
    mark_.enter(DecimationPhase::heap);
    if (key < kRefused) {
      heap_.set(element, key);
    } else {
      heap_.erase(element);
    }
  }

  static constexpr std::size_t kProgressStride = 1 << 14;

  Candidates& candidates_;
  const DecimateOptions& options_;
  PhaseMark mark_;
  Course course_;
  Heap heap_;
  Scratch scratch_;
  double popped_ = 0;
};

}  // namespace pmesh
