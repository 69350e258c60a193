// The greedy decimation engine: queue, legality, commit, log and stop rule around a metric.
// Private to core/decimate; the interface is decimate.h.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/decimate/border_loops.h"
#include "core/decimate/decimate.h"
#include "core/decimate/legality.h"
#include "core/decimate/metric.h"
#include "core/decimate/one_ring.h"
#include "core/decimate/parallel.h"
#include "core/decimate/vertex_heap.h"

namespace pmesh {

template <Metric M>
class Engine {
  static_assert(M::kPlacement == Placement::subset, "the collapse log has no relocations yet");

 public:
  Engine(HalfEdgeMesh mesh, std::span<const Vec3d> positions, const M& metric,
         const DecimateOptions& options)
      : mesh_(std::move(mesh)),
        positions_(positions),
        metric_(metric),
        options_(options),
        phase_(options.phase != nullptr ? *options.phase : own_phase_),
        scale_(unit_scale(positions)),
        borders_(mesh_),
        heads_(mesh_.vertex_slots()) {
    assert(positions.size() == mesh_.vertex_slots());
    assert(options.locked.empty() || options.locked.size() == positions.size());
    log_.collapses.reserve(mesh_.live_vertices());
  }

  Decimation run() {
    evaluate_all();
    collapse_all();
    if (mesh_.live_faces() > options_.base_faces) run_relaxed();
    DecimationReport report{mesh_.live_faces(), mesh_.live_vertices(), relaxed_at_faces_};
    return {std::move(mesh_), std::move(log_), report};
  }

 private:
  struct Candidate {
    VertexId head;  // invalid: there is no legal candidate
    double key = 0;
  };

  // What one thread needs to evaluate a vertex.
  struct Scratch {
    OneRing ring;
    MovedFaces moved;
    std::array<double, OneRing::kMaxFaces + 1> costs;
  };

  // The queue is empty above the target: only fold-overs are left. Nothing else can have become
  // legal unnoticed, because a link condition only comes to hold if the common neighbour in its
  // way, or a vertex between, is removed: then the candidate's ends are neighbours of that vertex.
  void run_relaxed() {
    const std::uint32_t faces = mesh_.live_faces();
    may_fold_over_ = true;
    popped_key_ = 0;
    evaluate_all();
    collapse_all();
    if (mesh_.live_faces() < faces) relaxed_at_faces_ = faces;
  }

  void evaluate_all() {
    enter(DecimationPhase::evaluate_all);
    const std::uint32_t count = mesh_.vertex_slots();
    std::vector<VertexHeap::Entry> entries(count);
    for_blocks(count, options_.threads, [&](std::uint32_t begin, std::uint32_t end) {
      Scratch scratch;
      for (std::uint32_t v = begin; v < end; ++v) {
        if (!mesh_.is_live(VertexId(v))) continue;
        if (!gather(VertexId(v), scratch)) continue;
        const Candidate best = cheapest(scratch, popped_key_);
        heads_[v] = best.head;
        if (best.head.valid()) entries[v] = {best.key, VertexId(v)};
      }
    });
    std::erase_if(entries, [](const VertexHeap::Entry& e) { return !e.vertex.valid(); });
    heap_.build(std::move(entries), count);
  }

  void collapse_all() {
    const std::uint64_t guess = log_.collapses.size() + collapses_to_go();
    while (mesh_.live_faces() > options_.base_faces && !heap_.empty()) {
      enter(DecimationPhase::heap);
      const VertexHeap::Entry popped = heap_.pop();
      popped_key_ = popped.key;
      collapse(popped.vertex);
      if (options_.progress && log_.collapses.size() % kProgressStride == 0) {
        options_.progress(log_.collapses.size(), guess);
      }
    }
  }

  // An estimate: vertices go in proportion to faces.
  std::uint64_t collapses_to_go() const {
    const std::uint64_t faces = mesh_.live_faces();
    if (faces <= options_.base_faces) return 0;
    return 1 + mesh_.live_vertices() * (faces - options_.base_faces) / faces;
  }

  // Collapses the popped vertex into the head that its evaluation chose, if the link condition
  // allows it.
  void collapse(VertexId removed) {
    enter(DecimationPhase::legality);
    [[maybe_unused]] const bool gathered = gather_neighbours(mesh_, removed, removed_ring_);
    assert(gathered);
    const VertexId kept = heads_[removed.value];
    if (!link_condition_holds(mesh_, removed_ring_, index_of(removed_ring_, kept))) {
      return queue_again(removed);
    }
    enter(DecimationPhase::collapse);
    if (removed_ring_.border) borders_.remove(removed);
    log_.collapses.push_back(mesh_.collapse(removed, mesh_.find_edge(removed, kept)));
    metric_.fold(removed, kept);
    for (std::uint32_t i = 0; i < removed_ring_.neighbours; ++i) queue(removed_ring_.ids[i]);
  }

  // Evaluates `v`, one of whose faces has changed. The link condition, which needs the rings of
  // v's neighbours, waits until v is popped: it refuses few, and a refusal only raises the cost.
  void queue(VertexId v) {
    enter(DecimationPhase::gather);
    Candidate best;
    if (gather(v, scratch_)) {
      enter(DecimationPhase::cost);
      best = cheapest(scratch_, popped_key_);
    }
    put(v, best);
  }

  // Evaluates the popped vertex `v`, whose best candidate proved illegal, among its legal
  // candidates. Its key is what it would have been had the link condition been known before.
  void queue_again(VertexId v) {
    Candidate best;
    if (gather(v, scratch_)) best = cheapest_legal(scratch_);
    best.key = std::max(best.key, popped_key_);
    put(v, best);
  }

  // Gives `v` its place in the queue, or none if it has no candidate.
  void put(VertexId v, const Candidate& best) {
    enter(DecimationPhase::heap);
    heads_[v.value] = best.head;
    if (best.head.valid()) {
      heap_.set(v, best.key);
    } else {
      heap_.erase(v);
    }
  }

  // False if `v` must not be removed.
  bool gather(VertexId v, Scratch& scratch) const {
    if (!options_.locked.empty() && options_.locked[v.value] != 0) return false;
    if (!gather_neighbours(mesh_, v, scratch.ring)) return false;
    gather_geometry(positions_, scale_, borders_, scratch.ring);
    return true;
  }

  // The cheapest candidate of the gathered vertex, legal but for the link condition.
  Candidate cheapest(Scratch& scratch, double popped_key) const {
    for (std::uint32_t head = 0; head < scratch.ring.neighbours; ++head) {
      scratch.costs[head] = cost(scratch.ring, head, scratch.moved);
    }
    return candidate(scratch, least(scratch), popped_key);
  }

  // The same with the link condition.
  Candidate cheapest_legal(Scratch& scratch) const {
    static_cast<void>(cheapest(scratch, 0));
    std::uint32_t head = least(scratch);
    while (head != kNoIndex && !link_condition_holds(mesh_, scratch.ring, head)) {
      scratch.costs[head] = kRefused;
      head = least(scratch);
    }
    return candidate(scratch, head, 0);
  }

  Candidate candidate(const Scratch& scratch, std::uint32_t head, double popped_key) const {
    if (head == kNoIndex) return {};
    const double key = metric_.priority(scratch.ring, scratch.costs[head], popped_key);
    return {scratch.ring.ids[head], key};
  }

  // Infinite if the candidate is refused.
  double cost(const OneRing& ring, std::uint32_t head, MovedFaces& moved) const {
    if (!may_move_to(ring, head)) return kRefused;
    move_faces(ring, head, moved);
    if (!may_fold_over_ && folds_over(moved)) return kRefused;
    return metric_.propose(ring, head, moved).cost;
  }

  // The neighbour of the least finite cost, or kNoIndex.
  static std::uint32_t least(const Scratch& scratch) {
    const auto& [ring, moved, costs] = scratch;
    std::uint32_t best = kNoIndex;
    for (std::uint32_t i = 0; i < ring.neighbours; ++i) {
      if (!(costs[i] < kRefused)) continue;
      if (best == kNoIndex || costs[i] < costs[best] ||
          (costs[i] == costs[best] && tie_rank(ring.ids[i]) < tie_rank(ring.ids[best]))) {
        best = i;
      }
    }
    return best;
  }

  static std::uint32_t index_of(const OneRing& ring, VertexId v) {
    std::uint32_t i = 0;
    while (ring.ids[i] != v) ++i;
    assert(i < ring.neighbours);
    return i;
  }

  void enter(DecimationPhase phase) { phase_.store(phase, std::memory_order_relaxed); }

  static constexpr double kRefused = std::numeric_limits<double>::infinity();
  static constexpr std::size_t kProgressStride = 1 << 14;

  HalfEdgeMesh mesh_;
  std::span<const Vec3d> positions_;
  M metric_;
  const DecimateOptions& options_;
  std::atomic<DecimationPhase> own_phase_;
  std::atomic<DecimationPhase>& phase_;
  double scale_;
  BorderLoops borders_;
  std::vector<VertexId> heads_;  // by vertex in the heap: the kept vertex of its best candidate
  VertexHeap heap_;
  CollapseLog log_;
  bool may_fold_over_ = false;
  double popped_key_ = 0;
  std::optional<std::uint32_t> relaxed_at_faces_;
  Scratch scratch_;
  OneRing removed_ring_;  // neighbours only
};

}  // namespace pmesh
