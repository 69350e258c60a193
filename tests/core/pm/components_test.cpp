// PM files of many components: which stand in the base, and those that begin chunks.
#include "core/pm/components.h"

#include <functional>

#include <gtest/gtest.h>

#include "core/pm/base_codec.h"
#include "core/pm/mesh_section.h"
#include "core/pm/stream_decoder.h"
#include "core/precompute/quantise.h"
#include "tests/fixtures/pm_files.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

FileIndex index_of(const EncodedShape& shape) { return **parse_prologue(shape.file); }

RefinableMesh decoded(const EncodedShape& shape) {
  StreamDecoder decoder(decode_base);
  const Status fed = decoder.feed(shape.file);
  EXPECT_TRUE(fed.ok()) << shape.name << ": " << fed.error().message;
  EXPECT_TRUE(decoder.complete()) << shape.name;
  return std::move(decoder.mesh());
}

// 16,000 pieces, some of which can be decimated; made once.
const EncodedShape& many_pieces() {
  static const EncodedShape shape = encode_shape("pieces", shapes::components(16'000));
  return shape;
}

const EncodedShape& triangles_alone() {
  static const EncodedShape shape = encode_shape("alone", shapes::isolated_triangles(3000), 16);
  return shape;
}

// Components of one size with finer ones between them, on which splits relocate.
const EncodedShape& relocating_pieces() {
  static const EncodedShape shape = encode_relocating_shape(
      "relocating pieces",
      shapes::joined(shapes::components(3000), shapes::bumped(shapes::icosphere(4), 0.1)));
  return shape;
}

TEST(Components, TheFirstPictureOfManyIsWithinSixteenKibibytes) {
  for (const EncodedShape* shape : {&many_pieces(), &triangles_alone()}) {
    const FileIndex index = index_of(*shape);
    EXPECT_TRUE(index.header.has_arrivals);
    EXPECT_LE(index.base_end(), 16u * 1024) << shape->name;
    EXPECT_GE(index.header.base_faces, 500u) << shape->name;
  }
}

TEST(Components, ComeBackWithoutLoss) {
  for (const EncodedShape* shape : {&many_pieces(), &triangles_alone(), &relocating_pieces()}) {
    const RefinableMesh mesh = decoded(*shape);
    EXPECT_TRUE(mesh.connectivity().validate().ok());
    EXPECT_TRUE(same_triangles(mesh.snapshot(), shape->quantised)) << shape->name;
  }
}

TEST(Components, EveryLodIsTheSameRefinedAndCoarsened) {
  for (const EncodedShape* shape : {&many_pieces(), &triangles_alone(), &relocating_pieces()}) {
    RefinableMesh refined = decoded(*shape), coarsened = refined;
    refined.set_steps(0);
    const std::uint32_t base = refined.face_count();
    const auto full = static_cast<std::uint32_t>(shape->quantised.triangles.size());
    for (std::uint32_t faces = base; faces <= full; faces += (full - base) / 17) {
      refined.set_faces(faces);
      coarsened.set_finest();
      coarsened.set_faces(faces);
      EXPECT_LE(refined.face_count(), faces);
      EXPECT_EQ(refined.applied_steps(), coarsened.applied_steps());
      const LatticeMesh a = refined.snapshot(), b = coarsened.snapshot();
      EXPECT_TRUE(a.positions == b.positions && a.triangles == b.triangles) << shape->name;
      EXPECT_TRUE(refined.connectivity().validate().ok());
    }
  }
}

TEST(Components, ChunkEndsHaveTheCountsOfTheirRows) {
  for (const EncodedShape* shape : {&many_pieces(), &triangles_alone(), &relocating_pieces()}) {
    const FileIndex index = index_of(*shape);
    RefinableMesh mesh = decoded(*shape);
    for (std::size_t chunks = 0; chunks <= index.chunks.size(); ++chunks) {
      mesh.set_vertices(index.vertices_after(chunks));
      EXPECT_EQ(mesh.vertex_count(), index.vertices_after(chunks));
      EXPECT_EQ(mesh.face_count(), index.faces_after(chunks));
    }
  }
}

TEST(Components, AChunkMayHaveNoSplits) {
  const FileIndex index = index_of(triangles_alone());
  ASSERT_FALSE(index.chunks.empty());
  for (std::size_t c = 0; c < index.chunks.size(); ++c) {
    EXPECT_EQ(index.added_by_splits(c), MeshCounts{});
    EXPECT_EQ(index.chunks[c].arrivals.vertices, 3 * index.chunks[c].arrivals.faces);
  }
}

TEST(Components, FewStandInTheBase) {
  const EncodedShape shape = encode_shape(
      "few", shapes::joined(shapes::components(30), shapes::bumped(shapes::icosphere(4), 0.1)));
  const FileIndex index = index_of(shape);
  EXPECT_FALSE(index.header.has_arrivals);
  for (const ChunkRow& row : index.chunks) EXPECT_EQ(row.arrivals, MeshCounts{});
}

TEST(Components, TheLargestStandsInTheBase) {
  const IndexedMesh large = shapes::moved(shapes::icosphere(5), {-9, 0, 0});
  IndexedMesh mesh = shapes::joined(shapes::isolated_triangles(3000), large);
  for (Vec3d& p : mesh.positions) p = p.x < -5 ? 1e4 * p : p;
  RefinableMesh coarse = decoded(encode_shape("large", mesh));
  coarse.set_steps(0);
  bool has_large = false;  // on the left; all else is on the right
  for (const Vec3i p : coarse.positions()) has_large |= p.x < 1 << 10;
  EXPECT_TRUE(has_large);
}

TEST(Components, CutsOfTheFileChangeNothing) {
  const EncodedShape& shape = relocating_pieces();
  const LatticeMesh whole = decoded(shape).snapshot();
  StreamDecoder decoder(decode_base);
  for (std::size_t at = 0; at < shape.file.size(); at += 777) {
    const std::size_t step = std::min<std::size_t>(777, shape.file.size() - at);
    ASSERT_TRUE(decoder.feed(ByteView(shape.file).subspan(at, step)).ok());
  }
  ASSERT_TRUE(decoder.complete());
  EXPECT_EQ(decoder.mesh().snapshot().positions, whole.positions);
  EXPECT_EQ(decoder.mesh().snapshot().triangles, whole.triangles);
}

TEST(Components, ComeLargestFirstAndThenScattered) {
  IndexedMesh mesh = shapes::isolated_triangles(100);
  mesh = shapes::joined(std::move(mesh), shapes::bumped(shapes::icosphere(1), 0.1));
  std::vector<Vec3i> positions;
  for (const Vec3d p : mesh.positions) {
    positions.push_back({int(100 * p.x), int(100 * p.y), int(10 * p.z)});
  }
  positions.back() = {100, 100, 5000};
  const HalfEdgeMesh base =
      *HalfEdgeMesh::build(mesh.triangles, static_cast<std::uint32_t>(mesh.positions.size()));
  const CollapseLog no_log;
  const Components components(base, positions, no_log);
  ASSERT_EQ(components.count(), 101u);
  EXPECT_EQ(components.faces(0, 1), 80u);
  EXPECT_EQ(components.vertices(1, 101), 300u);
  std::int32_t farthest = 0;  // of the next few: they are not the first of a hundred in a row
  for (const Vec3i p : components.part(1, 6).mesh.positions) farthest = std::max(farthest, p.x);
  EXPECT_GT(farthest, 10'000);
}

// Of a file whose second chunk brings two tetrahedra and one split.
FileIndex small_index() {
  FileIndex index;
  FileHeader& h = index.header;
  h.has_arrivals = true;
  h.base_vertices = 4;
  h.base_faces = 4;
  h.base_bytes = 100;
  h.lattice = {{1, 2, 3}, 0.5, 12};
  h.vertices = 15;
  h.faces = 18;
  index.chunks.resize(2);
  index.chunks[0].bytes = 50;
  index.chunks[0].vertices = 6;
  index.chunks[0].faces = 8;
  index.chunks[1].bytes = 70;
  index.chunks[1].vertices = 15;
  index.chunks[1].faces = 18;
  index.chunks[1].arrivals = {8, 8};
  return index;
}

std::string error_of(const std::function<void(FileIndex&)>& change) {
  FileIndex index = small_index();
  change(index);
  const auto parsed = parse_prologue(write_prologue(index));
  return parsed ? "none" : parsed.error().message;
}

TEST(ComponentRows, ComeBackAsTheyWereWritten) {
  FileIndex index = small_index();
  const FileIndex back = **parse_prologue(write_prologue(index));
  EXPECT_TRUE(back.header.has_arrivals);
  EXPECT_EQ(back.chunks[0].arrivals, MeshCounts{});
  EXPECT_EQ(back.chunks[1].arrivals, (MeshCounts{8, 8}));
  EXPECT_EQ(back.added_by_splits(1), (MeshCounts{1, 2}));
}

TEST(ComponentRows, AreEightBytesLongerThanOthers) {
  FileIndex with = small_index(), without = small_index();
  without.header.has_arrivals = false;
  EXPECT_EQ(write_prologue(with).size(), write_prologue(without).size() + 2 * 8);
}

TEST(ComponentRows, AreRefusedIfTheirCountsCannotBe) {
  const auto error_with = [](MeshCounts arrivals) {
    return error_of([=](FileIndex& i) { i.chunks[1].arrivals = arrivals; });
  };
  EXPECT_EQ(error_with({8, 8}), "none");
  for (const MeshCounts& counts :
       {MeshCounts{0, 8}, MeshCounts{8, 0}, MeshCounts{2, 8}, MeshCounts{10, 8}, MeshCounts{8, 11},
        MeshCounts{8, 2}, MeshCounts{0xFFFF'FFFF, 0xFFFF'FFFF}, MeshCounts{7, 8}}) {
    EXPECT_EQ(error_with(counts), "index row 1: impossible counts")
        << counts.vertices << ' ' << counts.faces;
  }
}

TEST(ComponentRows, AreRefusedIfTheirBytesCannotHoldThem) {
  const auto grow = [](FileIndex& i) {
    i.chunks[1].arrivals = {4000, 4500};
    i.chunks[1].vertices = i.header.vertices = 4007;
    i.chunks[1].faces = i.header.faces = 4510;
  };
  EXPECT_EQ(error_of(grow), "index row 1: impossible counts");
  EXPECT_EQ(error_of([&](FileIndex& i) {
              grow(i);
              i.chunks[1].bytes = 71;
            }),
            "none");
  EXPECT_EQ(error_of([](FileIndex& i) { i.chunks[1].bytes = 64 + 64 + 64 * 8 + 4096 + 1; }),
            "index row 1: impossible counts");
}

TEST(ComponentRows, HoldTheCallersLimits) {
  FileIndex index = small_index();
  DecodeLimits limits;
  limits.max_base_faces = 7;
  EXPECT_FALSE(parse_prologue(write_prologue(index), limits).ok());
}

// The error that decoding gives up to the first chunk when that is changed.
std::string error_with_chunk(const EncodedShape& shape, const std::function<void(Bytes&)>& change) {
  FileIndex index = index_of(shape);
  const auto begin = shape.file.begin() + static_cast<std::ptrdiff_t>(index.base_end());
  Bytes chunk(begin, begin + index.chunks[0].bytes);
  change(chunk);
  index.chunks[0].bytes = static_cast<std::uint32_t>(chunk.size());
  Bytes file = write_prologue(index);
  file.insert(file.end(), shape.file.begin() + index.prologue_bytes, begin);
  file.insert(file.end(), chunk.begin(), chunk.end());

  DecodeLimits limits;
  limits.verify_checksums = false;
  StreamDecoder decoder(decode_base, limits);
  const Status fed = decoder.feed(file);
  if (fed.ok()) return "none";
  EXPECT_EQ(fed.error().code, ErrorCode::verification);
  EXPECT_EQ(decoder.mesh().vertex_count(), index.header.base_vertices);
  EXPECT_EQ(decoder.mesh().known_steps(), 0u);
  return fed.error().message;
}

TEST(ComponentChunks, AreRefusedIfTheirComponentsOverrunThem) {
  const auto with_length = [](std::uint32_t length) {
    return error_with_chunk(many_pieces(), [=](Bytes& chunk) {
      for (std::size_t i = 0; i < 4; ++i) chunk[i] = static_cast<std::uint8_t>(length >> 8 * i);
    });
  };
  EXPECT_EQ(with_length(0xFFFF'FFFF), "chunk 0: its new components overrun it");
  EXPECT_EQ(with_length(0), "chunk 0: its new components' bytes do not fit their faces");
}

TEST(ComponentChunks, AreRefusedIfBytesFollowComponentsWithoutSplits) {
  const std::string error =
      error_with_chunk(triangles_alone(), [](Bytes& chunk) { chunk.push_back(0); });
  EXPECT_EQ(error, "chunk 0: bytes follow the new components");
}

TEST(ComponentChunks, AnswerEveryDamagedByteAndStayAsTheyWere) {
  const FileIndex index = index_of(relocating_pieces());
  int refused = 0;
  for (std::size_t at = 0; at < index.chunks[0].bytes; at += 7) {
    const std::string error =
        error_with_chunk(relocating_pieces(), [=](Bytes& chunk) { chunk[at] ^= 0x55; });
    if (error != "none") ++refused;  // else a position is another one
  }
  EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace pmesh
