// One template for both ways of coding a batch of splits: with a ChunkReader it decodes, with a
// ChunkWriter it encodes. docs/pm-format.md, section "Batch", specifies what it does.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/pm/batch_mesh.h"
#include "core/pm/fan.h"
#include "core/pm/fan_choice.h"
#include "core/pm/format.h"
#include "core/pm/patch.h"
#include "core/pm/point_coder.h"
#include "core/pm/split_model.h"
#include "core/pm/split_section.h"
#include "core/refine/refinable_mesh.h"

namespace pmesh {

template <class Coder>
class SplitCoder {
 public:
  SplitCoder(Coder& coder, const FileHeader& header, SplitModel& model, const RefinableMesh& mesh,
             BatchMesh& state)
      : coder_(coder), header_(header), model_(model), mesh_(mesh), state_(state) {}

  /// Decodes the next batch, of at most `most` splits, into `batch`, or encodes `batch`, whose
  /// splits are in that `order` of their kept vertices, with `parameters`; the rest of a sweep has
  /// those of the batch before. Fills in the costs. Afterwards the batch's faces are covered:
  /// BatchMesh::apply() comes next.
  Status code(std::vector<BatchSplit>& batch, std::uint32_t most,
              BatchOrder order = BatchOrder::ids, const BatchParameters& parameters = {}) {
    batch_ = &batch;
    coder_.enter(SplitSection::batches);
    const std::uint32_t count = code_count(static_cast<std::uint32_t>(batch.size()));
    if (count > most) return bad_input("a batch has more splits than its chunk");
    if constexpr (Coder::kDecodes) batch.clear();
    order = code_order(order);
    if (order != BatchOrder::rest_of_sweep) code_parameters(parameters);
    Status status = code_splits(count, order);
    if (status.ok() && failed()) return bad_input("the chunk ends inside a batch");
    return status;
  }

 private:
  bool failed() const {
    if constexpr (Coder::kDecodes) return coder_.failed();
    return false;
  }

  // Elias gamma.
  std::uint32_t code_count(std::uint32_t count) {
    const int bits = static_cast<int>(
        coder_.raw(5, static_cast<std::uint32_t>(count == 0 ? 0 : bit_length(count) - 1)));
    return (std::uint32_t{1} << bits) | coder_.raw(bits, count & ((std::uint32_t{1} << bits) - 1));
  }

  BatchOrder code_order(BatchOrder order) {
    if (coder_.bit(model_.goes_on, order == BatchOrder::rest_of_sweep)) {
      return BatchOrder::rest_of_sweep;
    }
    return coder_.bit(model_.sweeps, order == BatchOrder::sweep) ? BatchOrder::sweep
                                                                 : BatchOrder::ids;
  }

  void code_parameters(const BatchParameters& wanted) {
    BatchParameters& now = model_.parameters;
    const auto code_all = [this](auto& current, const auto& target) {
      for (std::size_t i = 0; i < current.size(); ++i) code_weight(current[i], target[i]);
    };
    for (std::size_t i = 0; i < kFanClasses; ++i) {
      if (i == kBorderFans && !header_.has_borders) continue;
      code_all(now.predictor.fans[i].tangential, wanted.predictor.fans[i].tangential);
      code_all(now.predictor.fans[i].normal, wanted.predictor.fans[i].normal);
    }
    if (header_.has_relocations) code_all(now.predictor.mirrored, wanted.predictor.mirrored);
    code_all(now.fan.of, wanted.fan.of);
  }

  // As a change: bit length in unary, sign and the bits below the leading one raw.
  void code_weight(std::int64_t& current, std::int64_t target) {
    const std::int64_t change = target - current;
    std::size_t length = 0;
    const auto wanted = static_cast<std::size_t>(bit_length(change));
    while (length < 8 && coder_.bit(model_.weight_length[length], wanted > length)) ++length;
    current = clamp_to(current + points_.code_tail(static_cast<int>(length), change), kMostWeight);
  }

  Status code_splits(std::uint32_t count, BatchOrder order) {
    if (order == BatchOrder::ids) return code_named(count);
    if (order == BatchOrder::sweep) {
      if (!state_.may_sweep()) return bad_input("a sweep begins too soon after the one before");
      state_.begin_sweep();
    }
    return code_marked(count, state_.rest_of_sweep());
  }

  // A mark at every vertex that may be split, until the last split.
  Status code_marked(std::uint32_t count, std::span<const VertexId> sweep) {
    std::size_t next = 0;
    for (std::size_t place = 0; place < sweep.size(); ++place) {
      const VertexId v = sweep[place];
      prefetch(sweep, place);
      if (state_.free_faces(v) == 0) continue;
      coder_.enter(SplitSection::marks);
      if (!coder_.bit(mark_model(v), is_wanted(next, v))) continue;
      if (Status coded = code_split(v, next++); !coded) return coded;
      if (next < count) continue;
      state_.take_off(place + 1);
      return {};
    }
    return bad_input("a batch has more splits than the mesh has vertices to split");
  }

  AdaptiveBit& mark_model(VertexId v) {
    const std::uint32_t free = std::min(state_.free_faces(v), SplitModel::kFree - 1);
    return model_.mark[is_border(v)][valence_class(v)][free];
  }

  // What the rings of the vertices at the next places need: from one place to the next each is
  // walked one face further, so that nobody waits for it.
  void prefetch(std::span<const VertexId> sweep, std::size_t place) {
    const HalfEdgeMesh& connectivity = mesh_.connectivity();
    if (place + 2 * kWalks < sweep.size()) {
      const VertexId v = sweep[place + 2 * kWalks];
      connectivity.prefetch(v);
      state_.prefetch(v);
    }
    if (mesh_.vertex_count() >= kLargeMesh) walk_on();
    if (place + kWalks < sweep.size()) {
      const VertexId v = sweep[place + kWalks];
      const HalfEdgeId first = connectivity.outgoing(v);
      walks_[place % kWalks] = first;
      connectivity.prefetch(first);
      mesh_.prefetch(v);
    }
  }

  void walk_on() {
    const HalfEdgeMesh& connectivity = mesh_.connectivity();
    for (HalfEdgeId& h : walks_) {
      if (!h.valid()) continue;
      h = connectivity.rotate_ccw(h);
      if (h.valid()) connectivity.prefetch(h);
    }
  }

  bool is_wanted(std::size_t next, VertexId v) const {
    if constexpr (Coder::kDecodes) return false;
    return (*batch_)[next].kept == v;
  }

  // The distance from one vertex to the next.
  Status code_named(std::uint32_t count) {
    std::uint64_t vertex = 0;
    for (std::size_t next = 0; next < count; ++next) {
      std::uint32_t gap = 0;
      if constexpr (!Coder::kDecodes) {
        gap = static_cast<std::uint32_t>((*batch_)[next].kept.value - vertex);
      }
      coder_.enter(SplitSection::marks);
      vertex += code_gap(gap);
      if (vertex >= mesh_.vertex_count()) return bad_input("a split's vertex does not exist");
      const VertexId v(static_cast<std::uint32_t>(vertex++));
      if (state_.free_faces(v) == 0) return bad_input("a split's vertex has no free face");
      if (Status coded = code_split(v, next); !coded) return coded;
    }
    return {};
  }

  std::uint32_t code_gap(std::uint32_t gap) {
    std::size_t length = 0;
    const auto wanted = static_cast<std::size_t>(bit_length(gap));
    while (length < 32 && coder_.bit(model_.gap_length[length], wanted > length)) ++length;
    if (length < 2) return static_cast<std::uint32_t>(length);
    const std::uint32_t top = std::uint32_t{1} << (length - 1);
    return top + coder_.raw(static_cast<int>(length) - 1, gap & (top - 1));
  }

  bool is_border(VertexId v) const {
    return header_.has_borders && mesh_.connectivity().is_border(v);
  }

  // The next split, which keeps `v`.
  Status code_split(VertexId v, std::size_t next) {
    if constexpr (Coder::kDecodes) {
      if (coder_.failed()) return bad_input("the chunk ends inside a batch");
      batch_->emplace_back();
    }
    BatchSplit& entry = (*batch_)[next];
    entry.kept = v;
    SplitSite& site = entry.split.site;
    coder_.enter(SplitSection::cuts);
    code_kind(v, site);
    Status cut = site.kind == SplitKind::interior ? code_interior(v, site) : code_border(v, site);
    if (!cut) return cut;
    state_.cover(mesh_, fan_);
    patch_.gather(mesh_, fan_);
    coder_.enter(SplitSection::positions);
    return code_positions(entry);
  }

  void code_kind(VertexId v, SplitSite& site) {
    SplitKind kind = SplitKind::interior;
    if (is_border(v)) {
      AdaptiveBit& model = model_.interior[valence_class(v)];
      if (!coder_.bit(model, site.kind == SplitKind::interior)) {
        kind = coder_.bit(model_.last, site.kind == SplitKind::border_last)
                   ? SplitKind::border_last
                   : SplitKind::border_first;
      }
    }
    site.kind = kind;
  }

  std::size_t valence_class(VertexId v) const {
    return std::min(state_.valence(v), SplitModel::kValences - 1);
  }

  // How many faces, from `least` to `most`.
  std::uint32_t code_size(VertexId v, std::uint32_t least, std::uint32_t most, std::uint32_t size) {
    auto& models = model_.larger[least];
    std::uint32_t coded = least;
    while (coded < most) {
      AdaptiveBit& model = models[std::min(coded, SplitModel::kFanSizes - 1)][valence_class(v)]
                                 [std::min(most, SplitModel::kFanSizes - 1)];
      if (!coder_.bit(model, size > coded)) break;
      ++coded;
    }
    return coded;
  }

  Status code_interior(VertexId v, SplitSite& site) {
    if (!ring_.gather(mesh_, v, state_.covered())) return code_at_hub(v, site);
    const std::uint32_t most = ring_.find_runs();
    if (most == 0) return bad_input("a split's vertex has no fan to split");
    const std::uint32_t size = code_size(v, 1, most, site.moved_faces);
    ring_.score(size, model_.parameters.fan);
    auto ranked = ring_.likeliest();
    for (std::size_t rank = 0; ranked[1] != VertexRing::kNone; ++rank) {
      const bool wanted = half_edge_of(ranked[0]) == site.half_edge;
      if (coder_.bit(candidate_model(ranked, rank), wanted)) break;
      ranked = ring_.likeliest(ranked[0]);
    }
    site.half_edge = half_edge_of(ranked[0]);
    site.moved_faces = static_cast<std::uint16_t>(size);
    fan_.take(v, ring_.run(VertexRing::first_face(ranked[0]), size));
    return {};
  }

  HalfEdgeId half_edge_of(VertexRing::Candidate c) const {
    return ring_.half_edge(VertexRing::first_face(c));
  }

  // By how much the likeliest of the candidates that are left leads the next, and the one after it.
  AdaptiveBit& candidate_model(const std::array<VertexRing::Candidate, 3>& ranked,
                               std::size_t rank) {
    const auto next = std::min<std::int64_t>(7, ring_.lead(ranked[0], ranked[1], 3) >> 4);
    const auto after = ranked[2] != VertexRing::kNone
                           ? std::min<std::int64_t>(3, ring_.lead(ranked[0], ranked[2], 1) >> 4)
                           : 3;
    return model_.candidate[std::min<std::size_t>(rank, 3)][static_cast<std::size_t>(next)]
                           [static_cast<std::size_t>(after)];
  }

  // Around a vertex of high valence, where walking its ring for every split could take for ever,
  // the first face is named.
  Status code_at_hub(VertexId v, SplitSite& site) {
    const std::uint32_t size = code_size(v, 1, kMaxMovedFaces, site.moved_faces);
    Status named = name_half_edge(v, site, false);
    if (!named) return named;
    site.moved_faces = static_cast<std::uint16_t>(size);
    return find_fan(site);
  }

  // By its face: the half-edge that leaves `v`, or if `incoming` the one that ends there.
  Status name_half_edge(VertexId v, SplitSite& site, bool incoming) {
    const std::uint32_t faces = mesh_.face_count();
    const std::uint32_t face = coder_.raw(bit_length(faces - 1), site.half_edge.value / 3);
    if (face >= faces) return bad_input("a split's face does not exist");
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      const HalfEdgeId h(3 * face + corner);
      if (mesh_.connectivity().origin(h) != v) continue;
      site.half_edge = incoming ? HalfEdgeMesh::prev(h) : h;
      return {};
    }
    return bad_input("a split's face is not its vertex's");
  }

  // Finds its fan if a split at `site`, whose half-edge is at its kept vertex, is possible and its
  // faces are free.
  Status find_fan(const SplitSite& site) {
    const HalfEdgeMesh& connectivity = mesh_.connectivity();
    if (Status possible = connectivity.check(site); !possible) return possible;
    fan_.walk(connectivity, site);
    return state_.is_free(fan_) ? Status() : bad_input("two splits cover a face");
  }

  Status code_border(VertexId v, SplitSite& site) {
    const bool last = site.kind == SplitKind::border_last;
    std::uint32_t most = kMaxMovedFaces;
    if (ring_.gather(mesh_, v, state_.covered())) {
      most = free_border_faces(last);
      const HalfEdgeId end = ring_.half_edge(last ? ring_.faces() - 1 : 0);
      const HalfEdgeId half_edge = last ? HalfEdgeMesh::prev(end) : end;
      site.half_edge = half_edge;
    } else if (Status named = name_half_edge(v, site, last); !named) {
      return named;
    }
    site.moved_faces = static_cast<std::uint16_t>(code_size(v, 0, most, site.moved_faces));
    return find_fan(site);
  }

  // At that end of the ring.
  std::uint32_t free_border_faces(bool last) const {
    std::uint32_t count = 0;
    while (count < ring_.faces() && ring_.is_free(last ? ring_.faces() - 1 - count : count)) {
      ++count;
    }
    return count;
  }

  Status code_positions(BatchSplit& entry) {
    const Predictor& predictor = model_.parameters.predictor;
    VertexSplit& split = entry.split;
    if (Status coded =
            points_.code(patch_, predict(patch_, predictor), model_.added, split.position);
        !coded) {
      return prefixed("added vertex", coded.error());
    }
    entry.cost = split_cost(patch_, split.position);
    if (!header_.has_relocations) return {};
    coder_.enter(SplitSection::relocations);
    Vec3i kept = patch_.kept + split.relocation;
    if (Status coded = points_.code(patch_, predict_kept(patch_, predictor, split.position),
                                    model_.kept, kept);
        !coded) {
      return prefixed("kept vertex", coded.error());
    }
    split.relocation = kept - patch_.kept;
    return {};
  }

  Coder& coder_;
  const FileHeader& header_;
  SplitModel& model_;
  const RefinableMesh& mesh_;
  BatchMesh& state_;
  std::vector<BatchSplit>* batch_ = nullptr;
  PointCoder<Coder> points_{coder_, header_.lattice.bits};
  static constexpr std::size_t kLargeMesh = 1 << 16;  // vertices that do not fit the caches
  static constexpr std::size_t kWalks = 6;
  std::array<HalfEdgeId, kWalks> walks_;  // around vertices to come, in turn
  VertexRing ring_;
  Fan fan_;
  Patch patch_;
};

}  // namespace pmesh
