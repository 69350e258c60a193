#include "core/metrics/feature_sensitive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "core/decimate/decimate.h"
#include "core/decimate/edge_star.h"
#include "core/metrics/blow_up.h"
#include "core/metrics/table.h"
#include "tests/core/decimate/rings.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

// A cube of side n, every side of n x n squares.
class Cube {
 public:
  explicit Cube(int n) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) add_squares(n, i, j);
    }
  }

  const IndexedMesh& mesh() const { return mesh_; }
  std::uint32_t at(int x, int y, int z) { return vertex({x, y, z}); }

 private:
  using Place = std::array<int, 3>;

  std::uint32_t vertex(Place p) {
    const auto [found, added] =
        ids_.try_emplace(p, static_cast<std::uint32_t>(mesh_.positions.size()));
    if (added) mesh_.positions.push_back({1.0 * p[0], 1.0 * p[1], 1.0 * p[2]});
    return found->second;
  }

  // Square (i, j) of all six sides.
  void add_squares(int n, int i, int j) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int level : {0, n}) {
        const auto corner = [&](int u, int v) {
          Place p{};
          p[axis] = level, p[(axis + 1) % 3] = u, p[(axis + 2) % 3] = v;
          return vertex(p);
        };
        std::array<std::uint32_t, 4> c = {corner(i, j), corner(i + 1, j), corner(i + 1, j + 1),
                                          corner(i, j + 1)};
        if (level == 0) std::swap(c[1], c[3]);
        mesh_.triangles.push_back({c[0], c[1], c[2]});
        mesh_.triangles.push_back({c[0], c[2], c[3]});
      }
    }
  }

  IndexedMesh mesh_;
  std::map<Place, std::uint32_t> ids_;
};

std::vector<double> blow_up_weights_of(const IndexedMesh& mesh) {
  return blow_up_weights(half_edges(mesh), mesh.positions, metric_frame(mesh.positions));
}

// A metric at its start on a mesh, and the stars that it is asked about.
class Begun {
 public:
  explicit Begun(const IndexedMesh& mesh, double weight = 0.03, bool blow_up = false)
      : work_(half_edges(mesh), mesh.positions), metric_(weight, blow_up) {
    metric_.start(work_.mesh(), work_.positions(), work_.frame());
  }

  FeatureSensitive& metric() { return metric_; }
  const WorkingMesh& work() const { return work_; }

  EdgeStar star(std::uint32_t a, std::uint32_t b) const {
    EdgeStar star;
    gather_ends(work_, work_.mesh().find_edge(VertexId(a), VertexId(b)), star);
    EXPECT_TRUE(gather_star(work_, star));
    return star;
  }
  Placement place(std::uint32_t a, std::uint32_t b) const { return metric_.place(star(a, b)); }

 private:
  WorkingMesh work_;
  FeatureSensitive metric_;
};

TEST(Quadric6, IsTheSquaredDistanceOffItsPlane) {
  const Point6 u{{1, 0, 0}, {}}, v{{0, 0.6, 0}, {0.8, 0, 0}};
  const Point6 on{{3, 2, 1}, {0, 1, 0}}, up{{0, -0.8, 0}, {0.6, 0, 0}};
  const Quadric6 q = Quadric6::plane(on, u, v);
  EXPECT_NEAR(q(on + 2 * u + -3 * v), 0, 1e-14);
  EXPECT_NEAR(q(on + 5 * u + 3 * up), 9, 1e-13);
  EXPECT_NEAR(q(on + 3 * up + Point6{{}, {0, 0, 4}}), 25, 1e-13);
}

TEST(Quadric6, MovesItsOrigin) {
  const Quadric6 q =
      Quadric6::plane({{3, 2, 1}, {0, 1, 0}}, {{1, 0, 0}, {}}, {{0, 0.6, 0}, {0.8, 0, 0}});
  const Vec3d origin{0.5, -1, 2}, p{1, 4, -2}, m{0.3, 0.2, 0.1};
  EXPECT_NEAR(q.relative_to(origin)({p, m}), q({origin + p, m}), 1e-13);
}

TEST(Quadric6, SlopeAndCurvatureDescribeItAlongALine) {
  const Quadric6 q =
      Quadric6::plane({{3, 2, 1}, {0, 1, 0}}, {{1, 0, 0}, {}}, {{0, 0.6, 0}, {0.8, 0, 0}});
  const Point6 at{{1, 4, -2}, {0.3, 0.2, 0.1}}, way{{-1, 2, 0.5}, {0.1, 0.7, -0.4}};
  EXPECT_NEAR(q(at + way), q(at) + 2 * q.slope(at, way) + q.curvature(way), 1e-12);
}

TEST(FeatureSensitive, VertexHasNoErrorWhereItIs) {
  Begun begun(shapes::bumped(shapes::icosphere(2), 0.05));
  const double weight = 0.03 / std::sqrt(3.0);  // of the sphere's cube; bumps change it little
  for (std::uint32_t v = 0; v < 20; ++v) {
    const Vec3d at = begun.work().frame().to_unit(begun.work().position(VertexId(v)));
    const double error =
        begun.metric().quadric(VertexId(v))({at, weight * begun.metric().normal(VertexId(v))});
    EXPECT_NEAR(error, 0, 1e-5);
  }
}

TEST(FeatureSensitive, FlatSurfaceCostsNothing) {
  Begun begun(shapes::grid(6, 6));
  const Placement placement = begun.place(3 * 7 + 3, 3 * 7 + 4);
  EXPECT_NEAR(placement.cost, 0, 1e-14);
  EXPECT_NEAR(length(placement.position), 0, 1e-6);
}

TEST(FeatureSensitive, TargetIsNoWorseThanEndsAndMiddle) {
  Begun begun(shapes::bumped(shapes::icosphere(2), 0.05), 0);  // no normals: any place is fair
  for (std::uint32_t v = 0; v < 40; ++v) {
    const VertexId neighbour =
        begun.work().mesh().target(begun.work().mesh().outgoing(VertexId(v)));
    const EdgeStar star = begun.star(v, neighbour.value);
    const Quadric6 q =
        (begun.metric().quadric(star.a) + begun.metric().quadric(star.b)).relative_to(star.origin);
    for (const Vec3d p : {Vec3d{}, star.position_a, star.position_b}) {
      EXPECT_LE(begun.metric().place(star).cost, q({p, {}}) + 1e-15);
    }
  }
}

TEST(FeatureSensitive, NormalOfTheTargetIsThatOfItsFaces) {
  Begun begun(shapes::bumped(shapes::icosphere(2), 0.05));
  const VertexId b = begun.work().mesh().target(begun.work().mesh().outgoing(VertexId(0)));
  const EdgeStar star = begun.star(0, b.value);
  const Placement placement = begun.metric().place(star);
  Vec3d sum;
  for (const EdgeStar::Face& f : star.faces) {
    sum += cross(f.second - placement.position, f.third - placement.position);
  }
  begun.metric().fold(star, VertexId(0), b, placement.position);
  EXPECT_NEAR(length(begun.metric().normal(b) - 1 / length(sum) * sum), 0, 1e-12);
}

TEST(FeatureSensitive, WeightMakesTurnsDear) {
  Cube cube(4);
  const std::uint32_t corner = cube.at(0, 0, 0), beside = cube.at(1, 0, 0);
  EXPECT_GT(Begun(cube.mesh(), 0.1).place(corner, beside).cost,
            2 * Begun(cube.mesh(), 0.01).place(corner, beside).cost);
}

TEST(FeatureSensitive, WeightIsALengthBesideTheLongestSide) {
  // In the grid's frame, lengths are in diagonals: the normals have w / sqrt(2).
  Begun begun(shapes::grid(6, 6));
  const VertexId v(3 * 7 + 3);
  const Vec3d at = begun.work().frame().to_unit(begun.work().position(v));
  const double w = 0.03 / std::sqrt(2.0), up = begun.metric().normal(v).z;
  EXPECT_NEAR(begun.metric().quadric(v)({at, {0, 0, w * up}}), 0, 1e-14);
  EXPECT_GT(begun.metric().quadric(v)({at, {0, 0, 0.9 * w * up}}), 1e-6);
}

TEST(FeatureSensitive, BorderVertexStaysOnItsLine) {
  const IndexedMesh mesh =
      shapes::grid(6, 6, [](double x, double y) { return 0.2 * x * x + 0.1 * y * y * y; });
  Begun begun(mesh);
  const EdgeStar star = begun.star(3, 3 + 7);  // from the border inwards
  ASSERT_NE(star.a_on_border, star.b_on_border);
  const Vec3d p = begun.metric().place(star).position;
  double nearest = 1;
  for (const EdgeStar::BorderEdge& edge : star.borders) {
    const Vec3d way = edge.to - edge.from, to = p - edge.from;
    const double t = std::clamp(dot(to, way) / dot(way, way), 0.0, 1.0);
    nearest = std::min(nearest, length(to - t * way));
  }
  EXPECT_NEAR(nearest, 0, 1e-12);
}

TEST(FeatureSensitive, FlatSheetKeepsItsCorners) {
  const IndexedMesh mesh = shapes::grid(8, 8);
  DecimateOptions options;
  options.schedule = Schedule::exact;
  options.base_faces = 8;
  options.metric = FeatureSensitive();
  const Decimation result = decimate(half_edges(mesh), mesh.positions, options);
  double low = 1e9, high = -1e9;
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    if (!result.mesh.is_live(VertexId(v))) continue;
    low = std::min(low, result.positions[v].x + result.positions[v].y);
    high = std::max(high, result.positions[v].x + result.positions[v].y);
  }
  const auto [first, last] = std::pair(mesh.positions.front(), mesh.positions.back());
  EXPECT_NEAR(low, first.x + first.y, 1e-3);
  EXPECT_NEAR(high, last.x + last.y, 1e-3);
}

TEST(FeatureSensitive, LogDoesNotDependOnThreads) {
  const IndexedMesh mesh = shapes::bumped(shapes::torus(24, 12), 0.05);
  DecimateOptions options;
  options.schedule = Schedule::exact;
  options.base_faces = 0;
  options.metric = FeatureSensitive(0.03, true);
  options.threads = 1;
  const Decimation one = decimate(half_edges(mesh), mesh.positions, options);
  options.threads = 3;
  const Decimation three = decimate(half_edges(mesh), mesh.positions, options);
  EXPECT_EQ(one.positions, three.positions);
  EXPECT_EQ(one.log.kept_before, three.log.kept_before);
}

TEST(FeatureSensitive, SurvivesFacesWithoutArea) {
  IndexedMesh mesh = shapes::icosphere(2);
  for (Vec3d& p : mesh.positions) p = {p.x, 0, 0};
  DecimateOptions options;
  options.schedule = Schedule::exact;
  options.base_faces = 0;
  options.metric = FeatureSensitive(0.03, true);
  const Decimation result = decimate(half_edges(mesh), mesh.positions, options);
  for (const Vec3d& p : result.positions) EXPECT_TRUE(std::isfinite(p.x + p.y + p.z));
  EXPECT_EQ(result.report.faces, 4u);
}

TEST(FeatureSensitive, ParametersRoundTrip) {
  for (const char* text : {"weight=0.03", "weight=0,blow-up", "weight=0.125,blow-up"}) {
    const Result<AnyMetric> metric = make_metric("feature-sensitive", text);
    ASSERT_TRUE(metric) << text;
    EXPECT_EQ(metric_parameters(*metric), text);
  }
  EXPECT_EQ(metric_parameters(*make_metric("feature-sensitive")), "weight=0.03");
}

TEST(FeatureSensitive, RefusesBadParameters) {
  for (const char* text : {"weight=-1", "weight", "weight=nan", "blow-up=1", "lambda=1"}) {
    EXPECT_FALSE(make_metric("feature-sensitive", text)) << text;
  }
}

TEST(BlowUp, SmoothVertexIsOnePoint) {
  for (const double weight : blow_up_weights_of(shapes::icosphere(3))) EXPECT_EQ(weight, 1);
}

TEST(BlowUp, RightAngledCreaseIsThreePoints) {
  Cube cube(2);
  EXPECT_EQ(blow_up_weights_of(cube.mesh())[cube.at(1, 0, 0)], 3);
}

TEST(BlowUp, CornerIsTheSumOfItsNeighboursAndOne) {
  Cube cube(2);
  const std::uint32_t corner = cube.at(0, 0, 0);
  const std::vector<double> weights = blow_up_weights_of(cube.mesh());
  std::set<std::uint32_t> neighbours;
  for (const Triangle& t : cube.mesh().triangles) {
    if (std::count(t.begin(), t.end(), corner) > 0) neighbours.insert(t.begin(), t.end());
  }
  neighbours.erase(corner);
  double sum = 1;
  for (const std::uint32_t v : neighbours) sum += weights[v];
  EXPECT_EQ(weights[corner], sum);
  EXPECT_GE(sum, 1 + 3 * 3);
}

TEST(BlowUp, TwoCornersHaveAPointBetweenThem) {
  // Every vertex of this cube is a corner: three creases of 3, and the diagonals' flat edges of 1.
  Cube cube(1);
  const std::uint32_t corner = cube.at(0, 0, 0);
  double expected = 1;
  std::set<std::uint32_t> neighbours;
  for (const Triangle& t : cube.mesh().triangles) {
    if (std::count(t.begin(), t.end(), corner) > 0) neighbours.insert(t.begin(), t.end());
  }
  neighbours.erase(corner);
  for (const std::uint32_t v : neighbours) {
    const double distance = length(cube.mesh().positions[v] - cube.mesh().positions[corner]);
    expected += distance > 1 ? 1 : 3;
  }
  EXPECT_EQ(blow_up_weights_of(cube.mesh())[corner], expected);
}

TEST(BlowUp, ConeIsACorner) {
  // A cone of 24 flat faces has no sharp edge, but its angles add up to less than 2 pi cos(pi/12).
  IndexedMesh mesh = shapes::hub(24);
  const auto highest = [&](double height) {
    IndexedMesh cone = mesh;
    cone.positions[0].z = height;
    return blow_up_weights_of(cone)[0];
  };
  EXPECT_EQ(highest(0.1), 1);
  EXPECT_EQ(highest(1), 1 + 24);
}

TEST(BlowUp, ScalesTheCostAlone) {
  Cube cube(4);
  const std::uint32_t a = cube.at(1, 0, 0), b = cube.at(2, 0, 0), inside = cube.at(2, 2, 0);
  const Begun plain(cube.mesh()), blown(cube.mesh(), 0.03, true);
  EXPECT_EQ(blown.place(a, b).position, plain.place(a, b).position);
  EXPECT_DOUBLE_EQ(blown.place(a, b).cost, (3 + 3) * plain.place(a, b).cost);
  const std::uint32_t beside = cube.at(2, 1, 0);
  EXPECT_DOUBLE_EQ(blown.place(beside, b).cost, 0.5 * (1 + 3) * plain.place(beside, b).cost);
  EXPECT_DOUBLE_EQ(blown.place(beside, inside).cost, plain.place(beside, inside).cost);
}

TEST(BlowUp, WeightsOfTwoFeaturesAddUpWhenTheyMerge) {
  Cube cube(4);
  const std::uint32_t a = cube.at(1, 0, 0), b = cube.at(2, 0, 0);
  Begun begun(cube.mesh(), 0.03, true);
  begun.metric().fold(begun.star(a, b), VertexId(a), VertexId(b), {});
  EXPECT_EQ(begun.metric().blow_up_weight(VertexId(b)), 6);
}

}  // namespace
}  // namespace pmesh
