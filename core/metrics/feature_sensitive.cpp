#include "core/metrics/feature_sensitive.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/box.h"
#include "core/decimate/edge_star.h"
#include "core/metrics/blow_up.h"

namespace pmesh {
namespace {

constexpr double kFlipPenalty = 3;
constexpr int kMaxSteps = 4;

// The search ends when a step turns the normal by no more than this angle's squared sine.
constexpr double kSettledSine2 = 1e-6;

// Where the error is flat in some direction, the least place in that direction is undetermined: it
// is drawn to where the search begins by a spring of this share of the quadric's trace.
constexpr double kSpring = 1e-6;

// The weight of a plane upright on a border edge, as qem.cpp has it. A face's plane weighs 1.
constexpr double kBorderWeight = 1000;

// Vectors are parallel, or a sum of vectors zero, if what is left of them is at most this share.
constexpr double kZeroRatio = 1e-10;

Vec3d unit_or_zero(Vec3d v) {
  const double norm = length(v);
  return norm > 0 ? 1 / norm * v : Vec3d{};
}

// The normal that the faces around the merged vertex give it, wherever it is placed: that of the
// sum of their area vectors, which is affine in the place (and constant around an interior vertex).
class StarNormal {
 public:
  StarNormal(const EdgeStar& star, Vec3d fallback) : fallback_(fallback) {
    for (const EdgeStar::Face& face : star.faces) {
      at_origin_ += cross(face.second, face.third);
      span_ += face.second - face.third;
      size2_ += dot(face.second, face.second) + dot(face.third, face.third);
    }
  }

  Vec3d at(Vec3d p) const {
    const Vec3d sum = at_origin_ + cross(p, span_);
    const double norm = length(sum);
    return norm > kZeroRatio * size2_ ? 1 / norm * sum : fallback_;
  }

 private:
  Vec3d fallback_;
  Vec3d at_origin_, span_;
  double size2_ = 0;
};

// The two-step optimisation (section 3.3): the least place under a fixed normal, then the normal
// that the faces have there.
class TargetSearch {
 public:
  TargetSearch(const Quadric6& error, const EdgeStar& star, double weight, Vec3d middle_normal)
      : quadric_(error),
        star_(star),
        weight_(weight),
        middle_normal_(middle_normal),
        normal_(star, middle_normal) {}

  Placement run() {
    const bool on_border = star_.a_on_border || star_.b_on_border;
    take(begin());
    Vec3d m = weight_ * middle_normal_;
    for (int step = 0; step < kMaxSteps; ++step) {
      const Quadric fixed = quadric_.at_normal(m);
      if (on_border) {
        search_border(fixed);
      } else {
        search_towards(fixed.least(kSpring));
      }
      const Vec3d turn = at_.m - m;
      if (dot(turn, turn) <= kSettledSine2 * weight_ * weight_) break;
      m = at_.m;
    }
    return {std::max(0.0, error_), at_.p};
  }

 private:
  // The edge's middle; its one end on a border.
  Vec3d begin() const {
    if (star_.a_on_border == star_.b_on_border) return {};
    return star_.a_on_border ? star_.position_a : star_.position_b;
  }

  Point6 lift(Vec3d p) const { return {p, weight_ * normal_.at(p)}; }

  // Keeps the place if its error is less than that of the best one so far.
  void take(Vec3d p) {
    const Point6 candidate = lift(p);
    const double error = quadric_(candidate);
    if (!(error < error_)) return;
    at_ = candidate;
    error_ = error;
  }

  // The line search from the best place to `least`: in six dimensions the error is quadratic on it.
  void search_towards(Vec3d least) {
    const Point6 way = lift(least) - at_;
    const double curvature = quadric_.curvature(way);
    if (!(curvature > 0)) return;
    const double t = std::clamp(-quadric_.slope(at_, way) / curvature, 0.0, 1.0);
    take(at_.p + t * way.p);
  }

  // Along the border lines of the ends that lie on a border (section 4.2).
  void search_border(const Quadric& fixed) {
    const double spring = kSpring * fixed.trace();
    for (const EdgeStar::BorderEdge& edge : star_.borders) {
      const Vec3d way = edge.to - edge.from;
      const double curvature = dot(way, fixed.times(way) + spring * way);
      if (!(curvature > 0)) continue;
      const Vec3d slope = fixed.times(edge.from) + fixed.b + spring * (edge.from - begin());
      take(edge.from + std::clamp(-dot(way, slope) / curvature, 0.0, 1.0) * way);
    }
  }

  const Quadric6& quadric_;
  const EdgeStar& star_;
  double weight_;
  Vec3d middle_normal_;
  StarNormal normal_;
  Point6 at_;
  double error_ = kRefused;
};

// The squared distance to the plane of a face (equation 7). None if its corners lie on a line.
std::optional<Quadric6> face_quadric(Point6 a, Point6 b, Point6 c) {
  Point6 longer = b - a, shorter = c - a;
  if (dot(longer, longer) < dot(shorter, shorter)) std::swap(longer, shorter);
  const double length2 = dot(longer, longer);
  if (!(length2 > 0)) return std::nullopt;
  const Point6 u = 1 / std::sqrt(length2) * longer;
  const Point6 upright = shorter - dot(shorter, u) * u;
  const double upright2 = dot(upright, upright);
  if (!(upright2 > kZeroRatio * kZeroRatio * length2)) return std::nullopt;
  return Quadric6::plane(a, u, 1 / std::sqrt(upright2) * upright);
}

double longest_side(std::span<const Vec3d> positions) {
  return positions.empty() ? 0 : bounding_box(positions).longest_side();
}

// What start() works on: the mesh in the unit frame.
class Start {
 public:
  Start(const HalfEdgeMesh& mesh, std::span<const Vec3d> positions, const MetricFrame& frame)
      : mesh_(mesh), positions_(positions), frame_(frame) {}

  std::vector<Vec3d> normals() const {
    std::vector<Vec3d> normals(mesh_.vertex_slots());
    for_each_face([&](FaceId face) {
      const Vec3d doubled = doubled_area(face);
      for (const VertexId v : corners(face)) normals[v.value] += doubled;
    });
    for (Vec3d& normal : normals) normal = unit_or_zero(normal);
    return normals;
  }

  std::vector<Quadric6> quadrics(std::span<const Vec3d> normals, double weight) const {
    std::vector<Quadric6> quadrics(mesh_.vertex_slots());
    const auto lift = [&](VertexId v) { return Point6{at(v), weight * normals[v.value]}; };
    for_each_face([&](FaceId face) {
      const auto c = corners(face);
      if (const auto plane = face_quadric(lift(c[0]), lift(c[1]), lift(c[2]))) {
        for (const VertexId v : c) quadrics[v.value] += *plane;
      }
      add_borders(face, quadrics);
    });
    return quadrics;
  }

 private:
  template <class Visit>
  void for_each_face(const Visit& visit) const {
    for (std::uint32_t f = 0; f < mesh_.face_slots(); ++f) {
      if (mesh_.is_live(FaceId(f))) visit(FaceId(f));
    }
  }

  Vec3d at(VertexId v) const { return frame_.to_unit(positions_[v.value]); }
  std::span<const VertexId> corners(FaceId face) const {
    return mesh_.corners().subspan(3 * std::size_t{face.value}, 3);
  }
  Vec3d doubled_area(FaceId face) const {
    const auto c = corners(face);
    return cross(at(c[1]) - at(c[0]), at(c[2]) - at(c[0]));
  }

  void add_borders(FaceId face, std::vector<Quadric6>& quadrics) const {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const HalfEdgeId h(3 * face.value + k);
      if (!mesh_.is_border(h)) continue;
      const VertexId from = mesh_.origin(h), to = mesh_.target(h);
      const Vec3d outward =
          unit_or_zero(cross(at(to) - at(from), unit_or_zero(doubled_area(face))));
      const Quadric plane = Quadric::plane(outward, -dot(outward, at(from)), kBorderWeight);
      quadrics[from.value].positions += plane;
      quadrics[to.value].positions += plane;
    }
  }

  const HalfEdgeMesh& mesh_;
  std::span<const Vec3d> positions_;
  MetricFrame frame_;
};

}  // namespace

void FeatureSensitive::start(const HalfEdgeMesh& mesh, std::span<const Vec3d> positions,
                             const MetricFrame& frame) {
  const Start start(mesh, positions, frame);
  unit_weight_ = weight_ * frame.scale * longest_side(positions);
  normals_ = start.normals();
  quadrics_ = start.quadrics(normals_, unit_weight_);
  if (blow_up_) blow_up_weights_ = pmesh::blow_up_weights(mesh, positions, frame);
}

Vec3d FeatureSensitive::middle_normal(const EdgeStar& star) const {
  return unit_or_zero(normal(star.a) + normal(star.b));
}

double FeatureSensitive::merged_weight(const EdgeStar& star) const {
  const double a = blow_up_weight(star.a), b = blow_up_weight(star.b);
  return a > 1 && b > 1 ? a + b : 0.5 * (a + b);
}

Placement FeatureSensitive::place(const EdgeStar& star) const {
  const Quadric6 error = (quadric(star.a) + quadric(star.b)).relative_to(star.origin);
  Placement placement = TargetSearch(error, star, unit_weight_, middle_normal(star)).run();
  placement.cost *= merged_weight(star);
  if (folds_over(star, placement.position)) placement.cost *= kFlipPenalty;
  return placement;
}

void FeatureSensitive::fold(const EdgeStar& star, VertexId removed, VertexId kept, Vec3d position) {
  normals_[kept.value] = StarNormal(star, middle_normal(star)).at(position);
  quadrics_[kept.value] += quadrics_[removed.value];
  if (blow_up_) blow_up_weights_[kept.value] = merged_weight(star);
}

}  // namespace pmesh
