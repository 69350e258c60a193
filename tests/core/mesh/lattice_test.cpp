#include "core/mesh/lattice.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/io/import.h"
#include "tests/fixtures/real_meshes.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

TEST(Lattice, EveryPointQuantisesToItself) {
  const Lattice lattice = make_lattice({{-3, 5e6, 1e-3}, {8, 5e6 + 2, 2e-3}}, 5).value();
  for (std::int32_t x = 0; x < 32; ++x) {
    for (const Vec3i point : {Vec3i{x, 0, 0}, Vec3i{31, x, 31}, Vec3i{3, 7, x}}) {
      EXPECT_EQ(lattice.quantise(lattice.position(point)), point);
    }
  }
}

TEST(Lattice, MovesNoPositionByMoreThanHalfAStep) {
  const IndexedMesh mesh = shapes::moved(shapes::bumped(shapes::torus(20, 12), 0.1), {5e6, 0, -7});
  for (const int bits : {kMinLatticeBits, 12, 24}) {
    const Lattice lattice = make_lattice(mesh.positions, bits).value();
    for (const Vec3d& p : mesh.positions) {
      const Vec3d moved = lattice.position(lattice.quantise(p)) - p;
      const double most = 0.5 * lattice.step + 2e-9;  // a unit in the last place of 5e6
      EXPECT_LE(std::max({std::abs(moved.x), std::abs(moved.y), std::abs(moved.z)}), most);
    }
  }
}

TEST(Lattice, SpansTheLongestSide) {
  for (int bits = kMinLatticeBits; bits <= kMaxLatticeBits; ++bits) {
    const Lattice lattice = make_lattice({{1, 2, 3}, {2, 9, 5}}, bits).value();
    const std::int32_t last = (std::int32_t{1} << bits) - 1;
    EXPECT_EQ(lattice.bits, bits);
    EXPECT_EQ(lattice.quantise({1, 2, 3}), (Vec3i{0, 0, 0}));
    EXPECT_EQ(lattice.quantise({1, 9, 3}), (Vec3i{0, last, 0}));
  }
}

TEST(Lattice, KeepsWhatLiesOutsideWithinItsBits) {
  const Lattice lattice = make_lattice({{0, 0, 0}, {1, 1, 1}}, 8).value();
  EXPECT_EQ(lattice.quantise({-1, 2, 1e300}), (Vec3i{0, 255, 255}));
}

TEST(Lattice, OfASinglePointHasStepOne) {
  const Lattice lattice = make_lattice({{4, 5, 6}, {4, 5, 6}}, 12).value();
  EXPECT_EQ(lattice.step, 1);
  EXPECT_EQ(lattice.position(lattice.quantise({4, 5, 6})), (Vec3d{4, 5, 6}));
}

TEST(Lattice, RejectsStepsFinerThanDoubles) {
  const Result<Lattice> lattice = make_lattice({{1e6, 0, 0}, {1e6 + 1e-3, 0, 0}}, 24);
  ASSERT_FALSE(lattice);
  EXPECT_EQ(lattice.error().message,
            "quantisation to 24 bits is finer than double precision at these coordinates");
  EXPECT_FALSE(make_lattice({{0, 0, 0}, {1e-307, 0, 0}}, 30));
}

TEST(Lattice, RejectsWhatIsNotFinite) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(make_lattice({{0, 0, 0}, {kInfinity, 0, 0}}, 12));
  EXPECT_FALSE(make_lattice({{0, 0, 0}, {0, kNan, 0}}, 12));
  EXPECT_FALSE(make_lattice({{-1.7e308, 0, 0}, {1.7e308, 0, 0}}, 12));
}

TEST(LatticeWithin, MovesNoCoordinateByMoreThanItsTolerance) {
  const IndexedMesh mesh = shapes::bumped(shapes::torus(20, 12), 0.1);
  for (const double tolerance : {0.1, 0.01, 1e-4, 1e-7}) {
    const Lattice lattice = make_lattice_within(mesh.positions, tolerance).value();
    for (const Vec3d& p : mesh.positions) {
      const Vec3d moved = lattice.position(lattice.quantise(p)) - p;
      EXPECT_LE(std::max({std::abs(moved.x), std::abs(moved.y), std::abs(moved.z)}),
                tolerance + 1e-15);
    }
  }
}

TEST(LatticeWithin, TakesTheCoarsestStepAndTheFewestBits) {
  const Lattice lattice = make_lattice_within({{0, 0, 0}, {1024, 3, 5}}, 0.5).value();
  EXPECT_EQ(lattice.step, 1);
  EXPECT_EQ(lattice.bits, 11);  // 0 to 1024
  EXPECT_EQ(lattice.quantise({1024, 3, 5}), (Vec3i{1024, 3, 5}));
  EXPECT_EQ(make_lattice_within({{0, 0, 0}, {1023, 3, 5}}, 0.5).value().bits, 10);
}

TEST(LatticeWithin, KeepsTheFewestBitsWhateverTheTolerance) {
  const Lattice lattice = make_lattice_within({{0, 0, 0}, {15, 3, 5}}, 1e300).value();
  EXPECT_EQ(lattice.bits, kMinLatticeBits);
  EXPECT_EQ(lattice.step, 1);
}

TEST(LatticeWithin, RejectsMoreBitsThanThereAre) {
  const Result<Lattice> lattice = make_lattice_within({{0, 0, 0}, {1, 0, 0}}, 1e-10);
  ASSERT_FALSE(lattice);
  EXPECT_EQ(lattice.error().message,
            "a tolerance of 1e-10 takes more than 30 bits a coordinate; at 30 bits it is 4.66e-10");
}

TEST(LatticeWithin, RejectsStepsFinerThanDoubles) {
  EXPECT_FALSE(make_lattice_within({{1e6, 0, 0}, {1e6 + 1e-3, 0, 0}}, 1e-11));
}

TEST(LatticeBits, FollowTheMedianEdge) {
  // 24 steps an edge: an edge of 1/64 of the side wants 1,536 steps, 11 bits.
  EXPECT_EQ(default_lattice_bits(shapes::grid(64, 64)), 11);
  EXPECT_EQ(default_lattice_bits(shapes::grid(128, 128)), 12);
}

TEST(LatticeBits, StayWithinTheirBounds) {
  EXPECT_EQ(default_lattice_bits(shapes::tetrahedron()), 10);
  EXPECT_EQ(default_lattice_bits(IndexedMesh{}), 10);
  IndexedMesh far_apart = shapes::isolated_triangles(1);
  for (Vec3d& p : far_apart.positions) p = 1e-9 * p;
  EXPECT_EQ(default_lattice_bits(shapes::joined(far_apart, shapes::moved(far_apart, {9, 9, 9}))),
            20);
}

class LatticeBitsOfScans : public testing::TestWithParam<const char*> {};

TEST_P(LatticeBitsOfScans, Are14) {
  PMESH_NEED_REAL_MESH(path, GetParam());
  EXPECT_EQ(default_lattice_bits(import_mesh(path)->mesh), 14);
}

INSTANTIATE_TEST_SUITE_P(, LatticeBitsOfScans,
                         testing::Values("dragon_vrip.ply", "happy_vrip_q14.ply"));

}  // namespace
}  // namespace pmesh
