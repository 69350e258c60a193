// The batched decimation engine: of the candidates below a threshold as many are collapsed at a
// time as do not meet, cheaper before dearer. No heap; vertices are swept in the order of their
// ids, that is, in space. Private to core/decimate; the interface is decimate.h.
//
// A batch is the set that a greedy choice in ascending order of ranks would give, found in rounds
// (M. Luby, A simple parallel algorithm for the maximal independent set problem, SIAM Journal on
// Computing 15(4), 1986): an element wins its round if it has the least rank of all that it meets.
// What needs only the mesh as it is (evaluating, winning, judging) is done by all threads.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <span>
#include <vector>

#include "core/decimate/batch_keys.h"
#include "core/decimate/batch_marks.h"
#include "core/decimate/course.h"
#include "core/decimate/decimate.h"
#include "core/decimate/engine.h"
#include "core/decimate/working_mesh.h"
#include "core/parallel/for_blocks.h"

namespace pmesh {

/// What the engine asks of a kind of candidate beyond EngineCandidates. Two elements meet if they
/// move, or remove, the same vertex or two neighbours.
template <class C>
concept BatchCandidates = EngineCandidates<C> &&
    requires(C& candidates, const C& const_candidates, typename C::ElementId element,
             typename C::Scratch& scratch, double key, const BatchMarks& marks) {
  { const_candidates.is_live(element) } -> std::same_as<bool>;
  /// The vertices that the collapse of a live element moves or removes.
  { const_candidates.moved(element)[0] } -> std::convertible_to<VertexId>;
  /// Whether an element can be collapsed at the key it has, on the mesh as it is.
  { const_candidates.may_collapse(element, key, scratch) } -> std::same_as<bool>;
  /// Collapses an element that may be, on a mesh changed since by others that it does not meet,
  /// which have left `marks`. False if they have taken what it needs.
  { candidates.collapse_unless_taken(element, key, marks, scratch) } -> std::same_as<bool>;
  /// Is told, for what it is worth, which element will be evaluated soon.
  { const_candidates.look_ahead(element) } -> std::same_as<void>;
  /// After a collapse: the vertices that were around the moved ones.
  { candidates.ring() } -> std::same_as<std::span<const VertexId>>;
};

template <BatchCandidates Candidates>
class BatchEngine {
 public:
  BatchEngine(WorkingMesh& work, Candidates& candidates, const DecimateOptions& options)
      : work_(work),
        candidates_(candidates),
        options_(options),
        mark_{options.phase},
        course_(work, options),
        keys_(candidates.slots(), 0),
        factors_(candidates.slots(), 1),
        is_changed_(candidates.slots(), 1),
        marks_(work.mesh().vertex_slots()),
        least_ranks_(work.mesh().vertex_slots(), kNoRank) {
    scratch_.mark = mark_;
    if constexpr (requires { candidates_.choose_ties_by_shape(); }) {
      candidates_.choose_ties_by_shape();
    }
    live_.reserve(candidates.slots());
    for (std::uint32_t i = 0; i < candidates.slots(); ++i) live_.push_back(ElementId(i));
  }

  DecimationReport run() {
    collapse_all();
    course_.run_relaxed(candidates_, [&] {
      std::fill(keys_.begin(), keys_.end(), 0.0f);
      std::fill(is_changed_.begin(), is_changed_.end(), std::uint8_t{1});
      collapse_all();
    });
    return course_.report();
  }

 private:
  using ElementId = typename Candidates::ElementId;
  using Scratch = typename Candidates::Scratch;

  /// What becomes of an open element.
  enum class Verdict : std::uint8_t { waits, collapses, taken };

  struct Step {
    float key;
    std::uint32_t tie;
    std::uint32_t place;  // in the batch's log
    friend bool operator<(const Step& a, const Step& b) {
      return a.key < b.key || (a.key == b.key && a.tie < b.tie);
    }
  };

  void collapse_all() {
    while (!course_.is_done()) {
      evaluate_changed();
      if (!open_batch()) return;
      while (!open_.empty() && !course_.is_done()) {
        choose_winners();
        collapse_winners();
      }
      end_batch();
    }
  }

  // Every changed element gets its key on the mesh as it is.
  void evaluate_changed() {
    mark_.enter(DecimationPhase::evaluate_all);
    std::erase_if(live_, [&](ElementId e) { return !candidates_.is_live(e); });
    for_blocks(count(live_), options_.threads, [&](std::uint32_t begin, std::uint32_t end) {
      Scratch scratch;
      for (std::uint32_t i = begin; i < end; ++i) {
        const std::uint32_t e = live_[i].value;
        if (is_changed_[e] == 0) continue;
        look_ahead(live_, i, end);
        keys_[e] = batch_key(candidates_.evaluate(live_[i], keys_[e], scratch));
        factors_[e] = keys_[e] < kNoKey ? coding_factor(scratch) : 1;
        is_changed_[e] = 0;
      }
    });
  }

  // Opens the elements that may be collapsed in the next batch; if it may be cut by the target, the
  // cheaper ones first. False if there are none.
  bool open_batch() {
    mark_.enter(DecimationPhase::heap);
    is_coarse_ = live_.size() < candidates_.slots() / kCoarse;
    threshold_ = batch_threshold<ElementId>([&](ElementId e) { return weighed(e); }, live_,
                                            is_coarse_, course_.collapses_to_go());
    open_.clear();
    for (const ElementId e : live_) {
      if (weighed(e) <= threshold_) open_.push_back(e);
    }
    if (open_.size() > course_.collapses_to_go()) {
      std::sort(open_.begin(), open_.end(),
                [&](ElementId a, ElementId b) { return rank(a) < rank(b); });
    }
    marks_.start_batch();
    steps_.clear();
    return !open_.empty();
  }

  void choose_winners() {
    mark_.enter(DecimationPhase::heap);
    for (const ElementId e : open_) {
      for (const VertexId v : candidates_.moved(e)) {
        least_ranks_[v.value] = std::min(least_ranks_[v.value], rank(e));
      }
    }
    verdicts_.resize(open_.size());
    for_blocks(count(open_), options_.threads, [&](std::uint32_t begin, std::uint32_t end) {
      Scratch scratch;
      for (std::uint32_t i = begin; i < end; ++i) {
        look_ahead(open_, i, end);
        verdicts_[i] = judge(open_[i], scratch);
      }
    });
    for (const ElementId e : open_) {
      for (const VertexId v : candidates_.moved(e)) least_ranks_[v.value] = kNoRank;
    }
  }

  // A winner that may not be collapsed gets another key.
  Verdict judge(ElementId e, Scratch& scratch) {
    if (!wins(e)) return Verdict::waits;
    float& key = keys_[e.value];
    if (candidates_.may_collapse(e, key, scratch)) return Verdict::collapses;
    key = batch_key(candidates_.evaluate_legal(e, key, scratch));
    return Verdict::waits;
  }

  bool wins(ElementId e) const {
    const BatchRank own = rank(e);
    const auto wins_at = [&](VertexId v) { return least_ranks_[v.value] >= own; };
    for (const VertexId v : candidates_.moved(e)) {
      if (!wins_at(v) || !all_neighbours(work_.mesh(), v, wins_at)) return false;
    }
    return true;
  }

  void collapse_winners() {
    for (std::uint32_t i = 0; i < open_.size() && !course_.is_done(); ++i) {
      look_ahead(open_, i, count(open_));
      if (verdicts_[i] == Verdict::collapses && !collapse(open_[i])) verdicts_[i] = Verdict::taken;
    }
    mark_.enter(DecimationPhase::heap);
    std::uint32_t left = 0;
    for (std::uint32_t i = 0; i < open_.size(); ++i) {
      if (verdicts_[i] == Verdict::waits && is_open(open_[i])) open_[left++] = open_[i];
    }
    open_.resize(left);
  }

  bool collapse(ElementId e) {
    const float key = keys_[e.value];
    if (!candidates_.collapse_unless_taken(e, key, marks_, scratch_)) return false;
    marks_.block(candidates_.ring());
    marks_.keep(work_.log().collapses.back().kept);
    steps_.push_back({key, tie_rank(e), count(steps_)});
    for (const ElementId changed : candidates_.changed()) change(changed, key);
    for (const ElementId touched : candidates_.touched()) {
      if (keys_[touched.value] == kNoKey) change(touched, key);
    }
    return true;
  }

  // `e` will be evaluated before the next batch; until then it has the key that it inherits.
  void change(ElementId e, float key) {
    is_changed_[e.value] = 1;
    keys_[e.value] = key;
  }

  bool is_open(ElementId e) const {
    if (!candidates_.is_live(e) || weighed(e) > threshold_) return false;
    const auto moved = candidates_.moved(e);
    return std::none_of(moved.begin(), moved.end(),
                        [&](VertexId v) { return marks_.is_blocked(v); });
  }

  // Logs the batch's steps in ascending order of their keys.
  void end_batch() {
    if (steps_.empty()) return;
    std::sort(steps_.begin(), steps_.end());
    order_.clear();
    for (const Step& step : steps_) order_.push_back(step.place);
    work_.end_batch(order_, Candidates::kCollapsesPerStep);
    course_.show_progress();
  }

  // While element `i` is dealt with, one of those that come next is brought into the caches.
  void look_ahead(const std::vector<ElementId>& elements, std::uint32_t i,
                  std::uint32_t end) const {
    constexpr std::uint32_t kAhead = 6;
    if (i + kAhead < end) candidates_.look_ahead(elements[i + kAhead]);
  }

  // What codes badly is put off, as long as most of the file's vertices are still there: by a
  // factor on the key, which threshold and rank go by. The log goes by the key itself.
  float weighed(ElementId e) const {
    return is_coarse_ ? keys_[e.value] : keys_[e.value] * factors_[e.value];
  }
  BatchRank rank(ElementId e) const { return batch_rank(weighed(e), e); }

  static float coding_factor(const Scratch& scratch) {
    if constexpr (requires { Candidates::coding_factor(scratch); }) {
      return static_cast<float>(Candidates::coding_factor(scratch));
    }
    return 1;
  }

  template <class T>
  static std::uint32_t count(const std::vector<T>& elements) {
    return static_cast<std::uint32_t>(elements.size());
  }

  WorkingMesh& work_;
  Candidates& candidates_;
  const DecimateOptions& options_;
  PhaseMark mark_;
  Course course_;
  Scratch scratch_;  // of the calling thread

  // By element.
  std::vector<float> keys_;     // kNoKey: no candidate
  std::vector<float> factors_;  // of the key
  std::vector<std::uint8_t> is_changed_;
  std::vector<ElementId> live_;

  // Of a batch.
  bool is_coarse_ = false;
  float threshold_ = 0;
  std::vector<ElementId> open_;    // may yet be collapsed in it
  std::vector<Verdict> verdicts_;  // on these
  std::vector<Step> steps_;
  std::vector<std::uint32_t> order_;
  BatchMarks marks_;
  std::vector<BatchRank> least_ranks_;  // by vertex: of the open elements that move it
};

}  // namespace pmesh
