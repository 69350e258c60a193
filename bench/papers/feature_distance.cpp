// The distance of two surfaces in feature-sensitive space, both ways.
//
//   papers_feature_distance A B WEIGHT
//
// A point of a surface is (p, WEIGHT n): its position, A's longest side being 1, and the unit
// normal, interpolated over a face from its corners' area-weighted vertex normals. From points of
// one surface (evenly over its area, and its vertices) the distance to the nearest point of the
// other, exactly. Prints a JSON object: longest_side in the file's unit, max and rms of the worse
// direction.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "bench/papers/mesh_file.h"
#include "core/base/box.h"

namespace pmesh::bench {
namespace {

using Point = std::array<double, 6>;

constexpr std::uint32_t kSamples = 200'000;

Point combine(const Point& a, double s, const Point& b) {  // a + s b
  Point sum;
  for (std::size_t i = 0; i < 6; ++i) sum[i] = a[i] + s * b[i];
  return sum;
}

double dot(const Point& a, const Point& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

double squared_to_segment(const Point& p, const Point& a, const Point& b) {
  const Point along = combine(b, -1, a), to = combine(p, -1, a);
  const double length = dot(along, along);
  const double at = length > 0 ? std::clamp(dot(to, along) / length, 0.0, 1.0) : 0.0;
  const Point rest = combine(to, -at, along);
  return dot(rest, rest);
}

struct Corners {
  Point a, b, c;
};

// To the plane if p falls into the triangle, else to the nearest edge: dot products alone, so that
// it holds in any dimension.
double squared_to_triangle(const Point& p, const Corners& t) {
  const Point u = combine(t.b, -1, t.a), v = combine(t.c, -1, t.a), to = combine(p, -1, t.a);
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), pu = dot(to, u), pv = dot(to, v);
  const double determinant = uu * vv - uv * uv;
  if (determinant > 1e-12 * uu * vv) {
    const double s = (vv * pu - uv * pv) / determinant, r = (uu * pv - uv * pu) / determinant;
    if (s >= 0 && r >= 0 && s + r <= 1) {
      const Point rest = combine(combine(to, -s, u), -r, v);
      return dot(rest, rest);
    }
  }
  return std::min({squared_to_segment(p, t.a, t.b), squared_to_segment(p, t.b, t.c),
                   squared_to_segment(p, t.c, t.a)});
}

// Faces in feature-sensitive space under a binary tree of boxes.
class FeatureSurface {
 public:
  FeatureSurface(const IndexedMesh& mesh, double longest_side, double weight) {
    std::vector<Vec3d> normals(mesh.positions.size());
    std::vector<Point> points;
    for (const Triangle& t : mesh.triangles) {
      const Vec3d normal = cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                                 mesh.positions[t[2]] - mesh.positions[t[0]]);
      areas_.push_back(length(normal));
      for (const std::uint32_t corner : t) normals[corner] += normal;
    }
    for (std::size_t v = 0; v < normals.size(); ++v) {
      const Vec3d p = 1 / longest_side * mesh.positions[v];
      const double size = length(normals[v]);
      const Vec3d n = size > 0 ? weight / size * normals[v] : Vec3d{};
      points.push_back({p.x, p.y, p.z, n.x, n.y, n.z});
      if (size > 0) vertices_.push_back(points.back());
    }
    for (const auto& [a, b, c] : mesh.triangles) {
      faces_.push_back({points[a], points[b], points[c]});
    }
    order_.resize(faces_.size());
    std::iota(order_.begin(), order_.end(), 0);
    nodes_.reserve(2 * faces_.size());
    add_node(0, static_cast<std::uint32_t>(order_.size()));
  }

  std::span<const Point> vertices() const { return vertices_; }  // without those of no face

  // Points evenly over the area, one at the middle of each stratum's width, spread over the face by
  // an additive recurrence of two irrational steps.
  template <class Visit>
  void sample(const Visit& visit) const {
    const double total = std::accumulate(areas_.begin(), areas_.end(), 0.0);
    double up_to = areas_[0];
    std::size_t face = 0;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      const double at = total * (i + 0.5) / kSamples;
      while (up_to < at && face + 1 < faces_.size()) up_to += areas_[++face];
      double s = std::fmod(0.7548776662466927 * i, 1), r = std::fmod(0.5698402909980532 * i, 1);
      if (s + r > 1) s = 1 - s, r = 1 - r;
      const Corners& t = faces_[face];
      visit(combine(combine(t.a, s, combine(t.b, -1, t.a)), r, combine(t.c, -1, t.a)));
    }
  }

  double squared_distance(const Point& p) const {
    double best = std::numeric_limits<double>::infinity();
    descend(0, p, best);
    return best;
  }

 private:
  struct Node {
    Point low, high;
    std::uint32_t begin, end;  // of order_
    std::uint32_t second = 0;  // the first child follows; 0: a leaf
  };

  std::uint32_t add_node(std::uint32_t begin, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    Node node{faces_[order_[begin]].a, faces_[order_[begin]].a, begin, end};
    for (std::uint32_t i = begin; i < end; ++i) {
      const Corners& t = faces_[order_[i]];
      for (std::size_t k = 0; k < 6; ++k) {
        node.low[k] = std::min({node.low[k], t.a[k], t.b[k], t.c[k]});
        node.high[k] = std::max({node.high[k], t.a[k], t.b[k], t.c[k]});
      }
    }
    nodes_.push_back(node);
    if (end - begin <= 4) return index;
    const Point size = combine(node.high, -1, node.low);
    const auto axis =
        static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
    const std::uint32_t middle = (begin + end) / 2;
    const auto key = [&](std::uint32_t f) {
      return faces_[f].a[axis] + faces_[f].b[axis] + faces_[f].c[axis];
    };
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t f, std::uint32_t g) { return key(f) < key(g); });
    add_node(begin, middle);
    const std::uint32_t second = add_node(middle, end);
    nodes_[index].second = second;
    return index;
  }

  double squared_to_box(const Node& node, const Point& p) const {
    double sum = 0;
    for (std::size_t k = 0; k < 6; ++k) {
      const double outside = std::max({node.low[k] - p[k], p[k] - node.high[k], 0.0});
      sum += outside * outside;
    }
    return sum;
  }

  void descend(std::uint32_t index, const Point& p, double& best) const {
    const Node& node = nodes_[index];
    if (node.second == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        best = std::min(best, squared_to_triangle(p, faces_[order_[i]]));
      }
      return;
    }
    std::array<std::uint32_t, 2> children = {index + 1, node.second};
    std::array<double, 2> squared = {squared_to_box(nodes_[children[0]], p),
                                     squared_to_box(nodes_[children[1]], p)};
    if (squared[1] < squared[0]) {
      std::swap(children[0], children[1]);
      std::swap(squared[0], squared[1]);
    }
    for (std::size_t k = 0; k < 2; ++k) {
      if (squared[k] < best) descend(children[k], p, best);
    }
  }

  std::vector<double> areas_;  // doubled
  std::vector<Point> vertices_;
  std::vector<Corners> faces_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

struct Distance {
  double max = 0, rms = 0;
};

Distance distance(const FeatureSurface& from, const FeatureSurface& to) {
  double most = 0, sum = 0;
  from.sample([&](const Point& p) {
    const double squared = to.squared_distance(p);
    most = std::max(most, squared);
    sum += squared;
  });
  for (const Point& p : from.vertices()) most = std::max(most, to.squared_distance(p));
  return {std::sqrt(most), std::sqrt(sum / kSamples)};
}

}  // namespace
}  // namespace pmesh::bench

int main(int argc, char** argv) {
  using namespace pmesh;
  if (argc != 4) bench::fail("usage: papers_feature_distance A B WEIGHT");
  const IndexedMesh mesh_a = bench::load_clean(argv[1]), mesh_b = bench::load_clean(argv[2]);
  const Box<double> box = bounding_box(std::span<const Vec3d>(mesh_a.positions));
  const double longest = box.longest_side();
  const double weight = std::atof(argv[3]);
  const bench::FeatureSurface a(mesh_a, longest, weight), b(mesh_b, longest, weight);
  const bench::Distance forward = distance(a, b), backward = distance(b, a);
  std::printf("{\"longest_side\": %.17g, \"max\": %.9g, \"rms\": %.9g}\n", longest,
              std::max(forward.max, backward.max), std::max(forward.rms, backward.rms));
}
