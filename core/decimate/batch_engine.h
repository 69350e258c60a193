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
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/decimate/batch_candidates.h"
#include "core/decimate/batch_elements.h"
#include "core/decimate/batch_keys.h"
#include "core/decimate/batch_log.h"
#include "core/decimate/batch_marks.h"
#include "core/decimate/course.h"
#include "core/decimate/decimate.h"
#include "core/decimate/working_mesh.h"
#include "core/parallel/workers.h"

namespace pmesh {

template <BatchCandidates Candidates>
class BatchEngine {
 public:
  BatchEngine(WorkingMesh& work, Candidates& candidates, const DecimateOptions& options)
      : work_(work),
        candidates_(candidates),
        elements_at_first_(candidates.slots()),
        mark_{options.phase},
        course_(work, options),
        workers_(options.threads),
        scratches_(workers_.count()),
        elements_(candidates.slots()),
        marks_(kOnVertices ? 0 : work.mesh().vertex_slots()),
        least_ranks_(work.mesh().vertex_slots(), kNoRank),
        log_(work.mesh().live_vertices()) {
    list_elements();
  }

  DecimationReport run() {
    collapse_all();
    course_.run_relaxed(candidates_, [&] {
      elements_ = BatchElements<ElementId>(candidates_.slots());
      collapse_all();
    });
    log_.sort(work_, Candidates::kCollapsesPerStep, workers_);
    return course_.report();
  }

 private:
  using ElementId = typename Candidates::ElementId;
  using Scratch = typename Candidates::Scratch;

  static constexpr bool kOnVertices = VertexCandidates<Candidates>;
  // Ids are made compact when no more than this share of the mesh is left.
  static constexpr double kSparse = 0.5;
  // At least so many, whatever the threads: see edit_winners().
  static constexpr std::uint32_t kRegions = 16;
  // What comes so many elements later is asked for now.
  static constexpr std::uint32_t kAhead = 6;

  // What becomes of an open element in a round.
  enum class Verdict : std::uint8_t {
    waits,
    collapses,
    collapses_apart,  // with all its neighbours in one region
    put_off,          // to the next round, for others' sake
    taken,            // what it keeps, by another: not in this batch
  };

  void collapse_all() {
    while (!course_.is_done()) {
      if constexpr (kOnVertices) compact();
      evaluate_changed();
      if (!open_batch()) return;
      while (!open_.empty() && !course_.is_done()) {
        choose_winners();
        collapse_winners();
        close_collapsed();
      }
      if (log_.end_batch(work_)) course_.show_progress();
    }
  }

  // Every changed element gets its key on the mesh as it is.
  void evaluate_changed() {
    mark_.enter(DecimationPhase::evaluate_all);
    keep_if(live_, [&](std::uint32_t i) { return candidates_.is_live(live_[i]); });
    const auto popped = [&](ElementId e) { return elements_.key(e); };
    const auto put = [&](ElementId e, double key, double coding_factor) {
      elements_.put(e, key, coding_factor);
    };
    const auto evaluate = [&](std::uint32_t begin, std::uint32_t end, std::uint32_t thread) {
      std::vector<ElementId> changed;
      for (std::uint32_t i = begin; i < end; ++i) {
        if (elements_.is_changed(live_[i])) changed.push_back(live_[i]);
      }
      candidates_.evaluate_each(changed, popped, put, scratch_of(thread));
    };
    for_blocks(count(live_), workers_, evaluate);
  }

  // Opens the elements that may be collapsed in the next batch; if the target may cut it short, the
  // cheaper ones first. False if there are none.
  bool open_batch() {
    mark_.enter(DecimationPhase::heap);
    is_coarse_ = live_.size() < elements_at_first_ / kCoarse;
    threshold_ = batch_threshold<ElementId>([&](ElementId e) { return weighed(e); }, live_,
                                            is_coarse_, course_.collapses_to_go());
    filter(
        count(live_), open_, workers_, [&](std::uint32_t i) { return live_[i]; },
        [&](std::uint32_t i) { return weighed(live_[i]) <= threshold_; });
    const bool may_be_cut =
        open_.size() * Candidates::kCollapsesPerStep >= course_.least_collapses_to_go();
    if (may_be_cut) {
      std::sort(open_.begin(), open_.end(),
                [&](ElementId a, ElementId b) { return rank(a) < rank(b); });
    }
    if constexpr (kOnVertices) {
      has_regions_ = !may_be_cut;
      region_bits_ = std::bit_width(candidates_.slots() / kRegions);
      candidates_.start_batch();
    }
    marks_.start_batch();
    return !open_.empty();
  }

  // A winner has the least rank of all that it meets.
  void choose_winners() {
    mark_.enter(DecimationPhase::heap);
    for_open([&](std::uint32_t i) { post_rank(open_[i]); });
    verdicts_.resize(open_.size());
    const auto judge_all = [&](std::uint32_t begin, std::uint32_t end, std::uint32_t thread) {
      Scratch& scratch = scratch_of(thread);
      for (std::uint32_t i = begin; i < end; ++i) {
        if constexpr (kOnVertices) {
          if (i + kAhead < end) candidates_.look_ahead(open_[i + kAhead]);
        }
        verdicts_[i] = judge(open_[i], scratch);
      }
    };
    for_blocks(count(open_), workers_, judge_all);
    for_open([&](std::uint32_t i) {
      for (const VertexId v : candidates_.moved(open_[i])) least_ranks_[v.value] = kNoRank;
    });
  }

  void post_rank(ElementId e) {
    for (const VertexId v : candidates_.moved(e)) {
      least_ranks_[v.value] = std::min(least_ranks_[v.value], rank(e));
    }
  }

  // A winner that may not be collapsed gets another key.
  Verdict judge(ElementId e, Scratch& scratch) {
    if (!wins(e)) return Verdict::waits;
    const float key = elements_.key(e);
    if (candidates_.may_collapse(e, key, scratch)) return Verdict::collapses;
    elements_.put_key(e, candidates_.evaluate_legal(e, key, scratch));
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
    filter(
        count(open_), winners_, workers_, [](std::uint32_t i) { return i; },
        [&](std::uint32_t i) { return verdicts_[i] == Verdict::collapses; });
    if constexpr (kOnVertices) {
      settle_winners();
      edit_winners();
    } else {
      mark_.enter(DecimationPhase::collapse);
      for (const std::uint32_t i : winners_) {
        if (course_.is_done()) return;
        if (!collapse(open_[i])) verdicts_[i] = Verdict::taken;
      }
    }
  }

  // Does for the winners what can be done before the mesh is edited.
  void settle_winners() {
    for (const std::uint32_t i : winners_) {
      if (!candidates_.claim(open_[i])) verdicts_[i] = Verdict::taken;
    }
    const auto settle_all = [&](std::uint32_t begin, std::uint32_t end, std::uint32_t thread) {
      for (std::uint32_t i = begin; i < end; ++i) {
        if (i + kAhead < end) candidates_.look_ahead_to_fold(open_[winners_[i + kAhead]]);
        settle(winners_[i], scratches_[thread].ring);
      }
    };
    for_blocks<1 << 8>(count(winners_), workers_, settle_all);
  }

  void settle(std::uint32_t winner, OneRing& ring) {
    if (verdicts_[winner] != Verdict::collapses) return;
    const ElementId e = open_[winner];
    if (!candidates_.stays_legal(e, ring)) {
      verdicts_[winner] = Verdict::put_off;
      return;
    }
    if (is_apart(ring)) verdicts_[winner] = Verdict::collapses_apart;
    candidates_.fold(e);
    for (std::uint32_t i = 0; i < ring.neighbours; ++i) {
      elements_.template change_by_one_of_many<Candidates::kInheritsKeys>(ring.ids[i],
                                                                          elements_.key(e));
    }
  }

  // Those that are apart, each region by one thread, then the others. (In an order that does not
  // depend on the threads: it shows in where a vertex's ring begins.)
  void edit_winners() {
    mark_.enter(DecimationPhase::collapse);
    done_.resize(winners_.size());
    const auto edit_region = [&](std::uint32_t region, std::uint32_t, std::uint32_t) {
      const auto is_before = [&](std::uint32_t winner, std::uint32_t of_region) {
        return region_of(open_[winner]) < of_region;
      };
      auto w = std::lower_bound(winners_.begin(), winners_.end(), region, is_before);
      for (; w != winners_.end() && region_of(open_[*w]) == region; ++w) {
        if (verdicts_[*w] != Verdict::collapses_apart) continue;
        done_[static_cast<std::size_t>(w - winners_.begin())] = candidates_.edit(open_[*w]);
      }
    };
    if (has_regions_) {
      for_blocks<1>(1 + (candidates_.slots() >> region_bits_), workers_, edit_region);
    }
    for (std::size_t w = 0; w < winners_.size() && !course_.is_done(); ++w) {
      const ElementId e = open_[winners_[w]];
      const Verdict verdict = verdicts_[winners_[w]];
      if (verdict == Verdict::put_off) candidates_.release(e);
      if (verdict == Verdict::collapses) done_[w] = candidates_.edit(e);
      if (verdict != Verdict::collapses && verdict != Verdict::collapses_apart) continue;
      work_.log(done_[w]);
      log_.add(elements_.key(e), tie_rank(name(e)));
    }
  }

  // Regions are ranges of ids, thus of space.
  std::uint32_t region_of(VertexId v) const { return v.value >> region_bits_; }

  bool is_apart(const OneRing& ring) const {
    const auto [least, greatest] =
        std::minmax_element(ring.ids.begin(), ring.ids.begin() + ring.neighbours);
    return has_regions_ && region_of(*least) == region_of(ring.centre) &&
           region_of(*greatest) == region_of(ring.centre);
  }

  bool collapse(ElementId e) {
    const float key = elements_.key(e);
    if (!candidates_.collapse(e, key, scratches_[0])) return false;
    marks_.block(candidates_.ring());
    log_.add(key, tie_rank(name(e)));
    for (const ElementId changed : candidates_.changed()) elements_.change(changed, key);
    for (const ElementId touched : candidates_.touched()) {
      if (elements_.key(touched) == kNoKey) elements_.change(touched, key);
    }
    return true;
  }

  // Leaves those open that may still be collapsed.
  void close_collapsed() {
    mark_.enter(DecimationPhase::heap);
    keep_if(open_, [&](std::uint32_t i) {
      const bool waits = verdicts_[i] == Verdict::waits || verdicts_[i] == Verdict::put_off;
      return waits && is_open(open_[i]);
    });
  }

  bool is_open(ElementId e) const {
    if (!candidates_.is_live(e)) return false;
    if constexpr (kOnVertices) return !elements_.is_changed(e) && weighed(e) <= threshold_;
    if (weighed(e) > threshold_) return false;
    const auto moved = candidates_.moved(e);
    return std::none_of(moved.begin(), moved.end(),
                        [&](VertexId v) { return marks_.is_blocked(v); });
  }

  // So that what is left of the mesh lies close together.
  void compact() {
    if (work_.mesh().live_vertices() > kSparse * work_.mesh().vertex_slots()) return;
    const CompactIds ids = work_.compact();
    for_blocks<1>(2, workers_, [&](std::uint32_t task, std::uint32_t, std::uint32_t) {
      if (task == 0) {
        candidates_.renumber(ids);
      } else {
        elements_.renumber(ids);
      }
    });
    least_ranks_.resize(candidates_.slots());
    list_elements();
  }

  void list_elements() {
    live_.clear();
    for (std::uint32_t i = 0; i < candidates_.slots(); ++i) live_.push_back(ElementId(i));
  }

  // What codes badly is put off, as long as most of the file's vertices are still there: by a
  // factor on the key, which threshold and rank go by. The log goes by the key itself.
  float weighed(ElementId e) const {
    return is_coarse_ ? elements_.key(e) : elements_.weighed_key(e);
  }
  BatchRank rank(ElementId e) const { return batch_rank(weighed(e), name(e)); }
  // The id that an element had at first.
  ElementId name(ElementId e) const {
    if constexpr (kOnVertices) return work_.name(e);
    return e;
  }

  // Calls work(i) for all places in open_, on several threads where no two elements share a vertex.
  template <class Work>
  void for_open(const Work& work) {
    const auto work_on_block = [&](std::uint32_t begin, std::uint32_t end, std::uint32_t) {
      for (std::uint32_t i = begin; i < end; ++i) work(i);
    };
    if constexpr (kOnVertices) {
      for_blocks<1 << 12>(count(open_), workers_, work_on_block);
    } else {
      work_on_block(0, count(open_), 0);
    }
  }

  // Keeps those elements at whose places keep(place) is true.
  template <class Keep>
  void keep_if(std::vector<ElementId>& elements, const Keep& keep) {
    filter(
        count(elements), filtered_, workers_, [&](std::uint32_t i) { return elements[i]; }, keep);
    elements.swap(filtered_);
  }

  // For a block of work; the mesh may have changed since the last.
  Scratch& scratch_of(std::uint32_t thread) {
    Scratch& scratch = scratches_[thread];
    if constexpr (requires { scratch.forget(); }) scratch.forget();
    return scratch;
  }

  template <class T>
  static std::uint32_t count(const std::vector<T>& elements) {
    return static_cast<std::uint32_t>(elements.size());
  }

  WorkingMesh& work_;
  Candidates& candidates_;
  const std::uint32_t elements_at_first_;
  PhaseMark mark_;
  Course course_;
  Workers workers_;
  std::vector<Scratch> scratches_;  // by thread

  BatchElements<ElementId> elements_;
  std::vector<ElementId> live_, filtered_;

  // Of a batch.
  bool is_coarse_ = false;
  bool has_regions_ = false;       // where winners that are apart may be edited at the same time
  std::uint32_t region_bits_ = 0;  // of an id, below those that name its region
  float threshold_ = 0;
  std::vector<ElementId> open_;         // may yet be collapsed in it
  std::vector<Verdict> verdicts_;       // on these
  std::vector<std::uint32_t> winners_;  // places in open_
  std::vector<HalfEdgeCollapse> done_;  // by them
  BatchMarks marks_;
  std::vector<BatchRank> least_ranks_;  // by vertex: of the open elements that move it

  BatchLog log_;
};

}  // namespace pmesh
