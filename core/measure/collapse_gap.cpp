#include "core/measure/collapse_gap.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pmesh {
namespace {

double between(double a, double b, double t) { return a + t * (b - a); }

Vec3d nearest_on_segment(Vec3d p, Vec3d a, Vec3d b) {
  const Vec3d edge = b - a;
  const double squared = dot(edge, edge);
  return squared > 0 ? a + std::clamp(dot(p - a, edge) / squared, 0.0, 1.0) * edge : a;
}

}  // namespace

// Along the vector area of a polygon.
class CollapseGap::View {
 public:
  explicit View(std::span<const Vec3d> polygon) : origin_(polygon[0]) {
    Vec3d sum;
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      sum += cross(polygon[i - 1] - origin_, polygon[i] - origin_);
    }
    const double size = length(sum);
    if (!(size > 0)) return;
    up_ = 1 / size * sum;
    const Vec3d across = cross(std::abs(up_.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}, up_);
    y_ = 1 / length(across) * across;
    x_ = cross(y_, up_);
    least_area_ = kLeastPart * size;
  }

  bool is_valid() const { return least_area_ > 0; }
  Seen see(Vec3d p) const {
    const Vec3d off = p - origin_;
    return {dot(off, x_), dot(off, y_), dot(off, up_)};
  }
  bool faces_up(const Face& face) const { return area(face.a, face.b, face.c) > least_area_; }

 private:
  // Of the polygon: a smaller face stands on its edge, or is but rounding.
  static constexpr double kLeastPart = 1e-10;

  Vec3d origin_, up_, x_, y_;
  double least_area_ = 0;
};

// Twice the signed area of a triangle as it is seen.
double CollapseGap::area(Seen a, Seen b, Seen c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Of a point in the face; negative outside.
double CollapseGap::Face::depth(Seen p) const {
  return std::min({area(a, b, p), area(b, c, p), area(c, a, p)});
}

double CollapseGap::Face::height_at(Seen p) const {
  const double of_a = area(b, c, p), of_b = area(c, a, p), of_c = area(a, b, p);
  return (of_a * a.z + of_b * b.z + of_c * c.z) / (of_a + of_b + of_c);
}

void CollapseGap::Patch::clear() {
  faces.clear();
  edges.clear();
  vertices.clear();
}

// Between a vertex and the face that it is over.
double CollapseGap::Patch::gap_below(Seen vertex) const {
  const Face* deepest = &faces.front();
  double depth = -std::numeric_limits<double>::infinity();
  for (const Face& face : faces) {
    if (const double d = face.depth(vertex); d > depth) {
      depth = d;
      deepest = &face;
    }
  }
  return std::abs(vertex.z - deepest->height_at(vertex));
}

// 0 if they do not cross.
double CollapseGap::gap_at_crossing(const Edge& e, const Edge& f) {
  const double f_from = area(e.a, e.b, f.a), f_to = area(e.a, e.b, f.b);
  if ((f_from > 0) == (f_to > 0)) return 0;
  const double e_from = area(f.a, f.b, e.a), e_to = area(f.a, f.b, e.b);
  if ((e_from > 0) == (e_to > 0)) return 0;
  return std::abs(between(e.a.z, e.b.z, e_from / (e_from - e_to)) -
                  between(f.a.z, f.b.z, f_from / (f_from - f_to)));
}

void CollapseGap::see_link(const View& view, std::span<const Vec3d> link) {
  link_.clear();
  for (const Vec3d p : link) link_.push_back(view.see(p));
  link_.push_back(link_.front());
  before_.clear();
  after_.clear();
}

// The faces between `center` and the link from `begin` to `end`, and their edges at the center.
void CollapseGap::add_fan(Patch& patch, Seen center, std::size_t begin, std::size_t end) const {
  for (std::size_t i = begin; i < end; ++i) {
    patch.faces.push_back({center, link_[i], link_[i + 1]});
    patch.edges.push_back({center, link_[i]});
  }
  patch.edges.push_back({center, link_[end]});
}

// Whether the link goes round `center` once, not twice, if all faces between them face up. (It may
// be on the link's last edge.)
bool CollapseGap::is_round(Seen center, bool on_border) const {
  if (on_border) {
    const Seen from = link_[link_.size() - 2], to = link_[0];
    return std::all_of(link_.begin() + 1, link_.end() - 2,
                       [&](Seen p) { return area(from, to, p) > 0; });
  }
  int times = 0;
  for (std::size_t i = 0; i + 1 < link_.size(); ++i) {
    if (link_[i].y < center.y && link_[i + 1].y >= center.y) ++times;
  }
  return times == 1;
}

// Whether both patches cover the polygon once, which is star-shaped about `center` if so.
bool CollapseGap::cover_once(const View& view, Seen center, bool on_border) const {
  const auto faces_up = [&](const Face& face) { return view.faces_up(face); };
  return std::all_of(before_.faces.begin(), before_.faces.end(), faces_up) &&
         std::all_of(after_.faces.begin(), after_.faces.end(), faces_up) &&
         is_round(center, on_border);
}

// Precondition: both cover the polygon once.
double CollapseGap::gap() const {
  constexpr std::size_t kMostPairs = 1 << 12;
  if (before_.edges.size() * after_.edges.size() > kMostPairs) return range_of_heights();
  double gap = 0;
  for (const Edge& e : before_.edges) {
    for (const Edge& f : after_.edges) gap = std::max(gap, gap_at_crossing(e, f));
  }
  for (const Seen vertex : before_.vertices) gap = std::max(gap, after_.gap_below(vertex));
  for (const Seen vertex : after_.vertices) gap = std::max(gap, before_.gap_below(vertex));
  return gap;
}

// No gap is larger.
double CollapseGap::range_of_heights() const {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const std::vector<Seen>& points : {link_, before_.vertices, after_.vertices}) {
    for (const Seen p : points) {
      low = std::min(low, p.z);
      high = std::max(high, p.z);
    }
  }
  return high - low;
}

std::optional<double> CollapseGap::of_half_edge(Vec3d removed, std::span<const Vec3d> link,
                                                bool on_border) {
  // On a border the removed vertex is brought to the new border first.
  const Vec3d center = on_border ? nearest_on_segment(removed, link.back(), link[0]) : removed;
  const double to_border = length(removed - center);
  if (link.size() == 2) return to_border;
  const View view(link);
  if (!view.is_valid()) return std::nullopt;
  see_link(view, link);
  const std::size_t last = link.size() - 1;
  before_.vertices.push_back(view.see(center));
  add_fan(before_, before_.vertices[0], 0, on_border ? last : last + 1);
  add_fan(after_, link_[0], 1, last);
  if (!cover_once(view, before_.vertices[0], on_border)) return std::nullopt;
  return to_border + gap();
}

std::optional<double> CollapseGap::of_edge(Vec3d first, Vec3d second, Vec3d merged,
                                           std::span<const Vec3d> link, std::size_t first_faces) {
  const View view(link);
  if (!view.is_valid()) return std::nullopt;
  see_link(view, link);
  const Seen a = view.see(first), b = view.see(second), center = view.see(merged);
  before_.vertices = {a, b};
  add_fan(before_, a, 0, first_faces);
  add_fan(before_, b, first_faces, link.size());
  before_.faces.push_back({a, link_[first_faces], b});
  before_.faces.push_back({a, b, link_[0]});
  before_.edges.push_back({a, b});
  after_.vertices.push_back(center);
  add_fan(after_, center, 0, link.size());
  if (!cover_once(view, center, false)) return std::nullopt;
  return gap();
}

}  // namespace pmesh
