// The bounds of the walk hold at every LOD: no sample of either surface is farther than they say.
#include "core/precompute/error_walk.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/measure/sampled_distance.h"
#include "core/pm/base_codec.h"
#include "core/pm/stream_decoder.h"
#include "tests/fixtures/pm_files.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

class Walk {
 public:
  Walk(const IndexedMesh& original, const EncodedShape& shape)
      : exported_(shape.lattice),
        frame_(*unit_frame(box_of_faces({original.positions, original.triangles}))),
        original_({original.positions, original.triangles}, frame_, 1) {
    EXPECT_TRUE(decoder_.feed(shape.file));
    walk_.emplace(decoder_.mesh(), shape.lattice, original, frame_);
  }

  std::uint32_t vertices() { return decoder_.mesh().vertex_count(); }
  void coarsen_to(std::uint32_t vertices) {
    walk_->plan_to(vertices);
    walk_->follow();
  }
  FaceErrors& errors() { return walk_->errors(); }
  double largest() {
    const std::vector<double>& bounds = errors().to_original;
    return *std::max_element(bounds.begin(), bounds.end());
  }

  double sampled_maximum() {
    const Surface lod = surface();
    return sampled_distance(lod, SurfaceSampler(lod, SurfaceSampler::Over::faces, 20'000, 1),
                            original_, 2)
        .max;
  }

  void expect_bounds_hold(const std::string& name) {
    const Surface surface = this->surface();
    ASSERT_EQ(errors().size(), surface.face_count());
    const SurfaceSampler samples(surface, SurfaceSampler::Over::faces, 3000, 1);
    samples.visit(0, samples.count(), [&](const SamplePoint& sample) {
      const Vec3d point = sample.on(surface.corners(sample.face));
      const double distance = std::sqrt(original_.nearest(point, kNoIndex).squared);
      EXPECT_LE(distance, errors().to_original[surface.given_face(sample.face)] + 1e-12) << name;
    });
    // Every point of the original is charged to a face that is as near as it says.
    const SurfaceSampler of_original(original_, SurfaceSampler::Over::faces, 200, 1);
    of_original.visit(0, of_original.count(), [&](const SamplePoint& sample) {
      const Vec3d point = sample.on(original_.corners(sample.face));
      bool is_near_one = false;
      for (std::uint32_t face = 0; face < surface.face_count() && !is_near_one; ++face) {
        const double bound = errors().from_original[surface.given_face(face)];
        is_near_one = std::sqrt(surface.squared_distance(point, face)) <= bound + 1e-12;
      }
      EXPECT_TRUE(is_near_one) << name;
    });
  }

 private:
  Surface surface() {
    const LatticeMesh lod = decoder_.mesh().snapshot();
    IndexedMesh mesh{{}, lod.triangles};
    for (const Vec3i p : lod.positions) mesh.positions.push_back(exported_(p));
    return Surface({mesh.positions, mesh.triangles}, frame_, 1);
  }

  ExportedPositions exported_;
  UnitFrame frame_;
  Surface original_;
  StreamDecoder decoder_{decode_base};
  std::optional<ErrorWalk> walk_;
};

void expect_sound(const IndexedMesh& original, const EncodedShape& shape) {
  Walk walk(original, shape);
  const std::uint32_t vertices = walk.vertices();
  for (int tenths = 10; tenths >= 0; tenths -= 2) {
    walk.coarsen_to(vertices * static_cast<std::uint32_t>(tenths) / 10);
    walk.expect_bounds_hold(shape.name + " at " + std::to_string(tenths) + " tenths");
  }
}

TEST(ErrorWalk, BoundsEveryFaceOfEveryShape) {
  for (const shapes::Shape& shape : shapes::manifolds()) {
    expect_sound(shape.mesh, encode_shape(shape.name, shape.mesh, 10));
  }
}

TEST(ErrorWalk, BoundsEveryFaceWhereVerticesRelocate) {
  for (const shapes::Shape& shape : shapes::manifolds()) {
    expect_sound(shape.mesh, encode_relocating_shape(shape.name, shape.mesh, 10));
  }
}

TEST(ErrorWalk, BoundsEveryFaceOfARoughSurface) {
  const IndexedMesh rough = shapes::bumped(shapes::torus(40, 30), 0.2);
  expect_sound(rough, encode_shape("rough torus", rough));
}

TEST(ErrorWalk, StaysNearTheTruth) {
  const IndexedMesh original = shapes::bumped(shapes::icosphere(5), 0.1);
  Walk walk(original, encode_shape("bumped sphere", original));
  walk.coarsen_to(walk.vertices() / 3);
  EXPECT_LE(walk.largest(), 8 * walk.sampled_maximum());
}

}  // namespace
}  // namespace pmesh
