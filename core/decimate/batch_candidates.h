// What the batched engine asks of a kind of candidate beyond what the exact one does (engine.h).
// Private to core/decimate.
#pragma once

#include <concepts>
#include <span>

#include "core/decimate/engine.h"
#include "core/decimate/metric.h"
#include "core/mesh/half_edge_mesh.h"

namespace pmesh {

/// Elements that are vertices, each removed by its own collapse: a batch judges them, and does for
/// them what can be done, before it edits the mesh, on several threads. They give vertices new ids.
template <class C>
concept VertexCandidates = requires(C& candidates, const C& const_candidates, VertexId v,
                                    OneRing& ring, const CompactIds& ids) {
  /// Whether a key depends on that of the collapse that made its evaluation necessary.
  { C::kInheritsKeys } -> std::convertible_to<bool>;
  /// BatchClaims' members, of an element's own ends. stays_legal() gathers its neighbours.
  { candidates.start_batch() } -> std::same_as<void>;
  { candidates.claim(v) } -> std::same_as<bool>;
  { candidates.release(v) } -> std::same_as<void>;
  { const_candidates.stays_legal(v, ring) } -> std::same_as<bool>;
  /// Folds the metric's state, as if it had been collapsed.
  { candidates.fold(v) } -> std::same_as<void>;
  /// Collapses it; to be logged.
  { candidates.edit(v) } -> std::same_as<HalfEdgeCollapse>;
  /// Follows the mesh to compact ids.
  { candidates.renumber(ids) } -> std::same_as<void>;
};

/// Others: after a collapse, the vertices that were around the moved ones.
template <class C>
concept OtherCandidates = requires(C& candidates) {
  { candidates.ring() } -> std::same_as<std::span<const VertexId>>;
};

/// What the engine asks of a kind of candidate. Two elements meet if they move, or remove, the same
/// vertex or two neighbours.
template <class C>
concept BatchCandidates = EngineCandidates<C> &&
    (VertexCandidates<C> || OtherCandidates<C>)&&requires(
        C& candidates, const C& const_candidates, typename C::ElementId element,
        std::span<const typename C::ElementId> elements, typename C::Scratch& scratch, double key,
        double (&popped)(typename C::ElementId),
        void (&put)(typename C::ElementId, double key, double coding_factor)) {
  { const_candidates.is_live(element) } -> std::same_as<bool>;
  /// The vertices that the collapse of a live element moves or removes.
  { const_candidates.moved(element)[0] } -> std::convertible_to<VertexId>;
  /// evaluate(element, popped(element)) for each, which it hands to `put`.
  { candidates.evaluate_each(elements, popped, put, scratch) } -> std::same_as<void>;
  /// Whether an element can be collapsed at the key it has, on the mesh as it is.
  { const_candidates.may_collapse(element, key, scratch) } -> std::same_as<bool>;
};

}  // namespace pmesh
