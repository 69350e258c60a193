// Split coder and decoder against each other, and against hand-made bits.
#include <gtest/gtest.h>

#include "core/pm/split_decoder.h"
#include "core/pm/split_encoder.h"

namespace pmesh {
namespace {

// A square of two faces, wound (0, 1, 2) and (0, 2, 3).
LatticeMesh square() {
  return {{{0, 0, 0}, {100, 0, 0}, {100, 100, 0}, {0, 100, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

FileHeader header_with_borders(bool relocations = false) {
  FileHeader header;
  header.lattice.bits = 10;
  header.has_borders = true;
  header.has_relocations = relocations;
  return header;
}

Bytes encode(const std::vector<VertexSplit>& splits, const FileHeader& header) {
  RefinableMesh mesh = *RefinableMesh::from_base(square());
  SplitEncoder encoder(header);
  for (const VertexSplit& split : splits) {
    encoder.put(split, mesh);
    EXPECT_TRUE(mesh.append(split).ok());
  }
  return std::move(encoder).finish();
}

// One of each kind: ears on two borders, an interior split of a border vertex.
const std::vector<VertexSplit> kSplits = {
    {{HalfEdgeId(0), 0, SplitKind::border_first}, {50, 0, 10}},
    {{HalfEdgeId(4), 1, SplitKind::border_last}, {1023, 0, 1023}},
    {{HalfEdgeId(2), 1, SplitKind::interior}, {0, 1023, 0}},
};

// The same, moving vertex 0 to a corner of the lattice and back, and vertex 2 not at all.
const std::vector<VertexSplit> kRelocatingSplits = {
    {{HalfEdgeId(0), 0, SplitKind::border_first}, {2, 0, 10}, {1023, 1023, 1023}},
    {{HalfEdgeId(4), 1, SplitKind::border_last}, {1023, 0, 1023}},
    {{HalfEdgeId(0), 1, SplitKind::interior}, {0, 1023, 0}, {-1023, -1023, -1023}},
};

void expect_round_trip(const std::vector<VertexSplit>& splits, const FileHeader& header) {
  RefinableMesh expected = *RefinableMesh::from_base(square());
  for (const VertexSplit& split : splits) ASSERT_TRUE(expected.append(split).ok());
  RefinableMesh mesh = *RefinableMesh::from_base(square());
  const auto count = static_cast<std::uint32_t>(splits.size());
  const Status decoded = decode_chunk(encode(splits, header), count, header, mesh);
  ASSERT_TRUE(decoded.ok()) << decoded.error().message;
  for (std::uint32_t k = count + 1; k-- > 0;) {
    mesh.set_splits(k);
    expected.set_splits(k);
    EXPECT_EQ(mesh.snapshot().positions, expected.snapshot().positions) << k;
    EXPECT_EQ(mesh.snapshot().triangles, expected.snapshot().triangles) << k;
  }
}

TEST(SplitCodec, GivesBackEveryKindOfSplit) { expect_round_trip(kSplits, header_with_borders()); }

TEST(SplitCodec, GivesBackRelocations) {
  expect_round_trip(kRelocatingSplits, header_with_borders(true));
  expect_round_trip(kSplits, header_with_borders(true));
}

TEST(SplitCodec, PacksTheBitsThatTheSpecificationSays) {
  const FileHeader header = header_with_borders();
  // kind 1,0; half-edge 0 of 6 in 3 bits; moved 0 as 0,00; three differences with Rice parameter 6:
  // zigzag(50) = 100 -> 1 0 and 36 in 6 bits; zigzag(0) -> 0 and 000000; zigzag(10) = 20.
  const Bytes bytes = encode({kSplits[0]}, header);
  EXPECT_EQ(bytes, (Bytes{0x01, 0x91, 0x00, 0x14}));
}

TEST(SplitCodec, PacksTheRelocationThatTheSpecificationSays) {
  // As above, then kept moves by (2, 0, 0) and was predicted at (-50, 0, -10): zigzag(52) = 104 ->
  // 1 0 and 40 in 6 bits; zigzag(0); zigzag(10) = 20.
  const VertexSplit split{kSplits[0].site, kSplits[0].position, {2, 0, 0}};
  const Bytes bytes = encode({split}, header_with_borders(true));
  EXPECT_EQ(bytes, (Bytes{0x01, 0x91, 0x00, 0x54, 0x28, 0x00, 0x05}));
}

void expect_exact_length(const std::vector<VertexSplit>& splits, const FileHeader& header) {
  const Bytes whole = encode(splits, header);
  for (std::size_t n = 0; n < whole.size(); ++n) {
    RefinableMesh mesh = *RefinableMesh::from_base(square());
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_FALSE(decode_chunk(cut, 3, header, mesh).ok()) << n;
  }
  Bytes longer = whole;
  longer.push_back(0);
  RefinableMesh mesh = *RefinableMesh::from_base(square());
  EXPECT_EQ(decode_chunk(longer, 3, header, mesh).error().message,
            "bytes are left over after the last split");
}

TEST(SplitCodec, RefusesBytesTooFewOrTooMany) {
  expect_exact_length(kSplits, header_with_borders());
  expect_exact_length(kRelocatingSplits, header_with_borders(true));
}

// What is wrong with an ear on half-edge 0, at the place of vertex 0, whose coordinates' codes are
// all zero but for number `wrong`, which is escaped and stands for `residual`.
std::string error_of_escape(int wrong, std::int32_t residual) {
  BitWriter bits;
  bits.put(1, 2);      // border_first
  bits.put(0, 3 + 3);  // half-edge 0, no moved face
  for (int k = 0; k < 6; ++k) {
    if (k != wrong) {
      bits.put(0, 7);
      continue;
    }
    bits.put((1u << 24) - 1, 24);
    bits.put(zigzag(residual), 32);
  }
  RefinableMesh mesh = *RefinableMesh::from_base(square());
  const Status decoded = decode_chunk(std::move(bits).finish(), 1, header_with_borders(true), mesh);
  return decoded ? "none" : decoded.error().message;
}

TEST(SplitCodec, RefusesPositionsOffTheLattice) {
  for (const std::int32_t residual : {-1, 1024, INT32_MAX, INT32_MIN}) {
    EXPECT_EQ(error_of_escape(1, residual), "split 0: added vertex: off the lattice");
    EXPECT_EQ(error_of_escape(5, residual), "split 0: kept vertex: off the lattice");
  }
  EXPECT_EQ(error_of_escape(1, 1023), "split 0: kept vertex: off the lattice");  // at -1023
  EXPECT_EQ(error_of_escape(5, 1023), "none");
}

TEST(SplitCodec, NoSplitTakesMoreThanTheFormatAllows) {
  constexpr std::int32_t kLast = (1 << 30) - 1;
  FileHeader header = header_with_borders(true);
  header.lattice.bits = 30;
  RefinableMesh mesh = *RefinableMesh::from_base({{{}, {}, {}}, {{0, 1, 2}}});
  SplitEncoder encoder(header);
  VertexSplit ear{{HalfEdgeId(0), 0, SplitKind::border_first}, {}};
  for (int k = 0; k < 500; ++k) {  // ears without extent teach the models to expect zero
    encoder.put(ear, mesh);
    ASSERT_TRUE(mesh.append(ear).ok());
    ear.site.half_edge = HalfEdgeId(3 * mesh.face_count() - 1);
  }
  ear.position = {kLast, kLast, kLast};
  ear.relocation = ear.position;
  const std::size_t before = encoder.byte_count();
  encoder.put(ear, mesh);
  EXPECT_LE(encoder.byte_count(), before + header.max_split_bytes());
  EXPECT_GT(encoder.byte_count(), before + kMaxSplitBytes);
}

TEST(SplitCodec, ZigzagAndBackIsTheIdentity) {
  for (const std::int32_t v : {0, -1, 1, -2, 1 << 29, -(1 << 29), INT32_MAX, INT32_MIN}) {
    EXPECT_EQ(unzigzag(zigzag(v)), v);
  }
}

TEST(Bits, ComeBackInOrderAndReportTheEnd) {
  BitWriter writer;
  writer.put(5, 3);
  writer.put(0xDEADBEEF, 32);
  writer.put(1, 1);
  const Bytes bytes = std::move(writer).finish();
  BitReader reader(bytes);
  EXPECT_EQ(reader.get(3), 5u);
  EXPECT_EQ(reader.get(32), 0xDEADBEEFu);
  EXPECT_EQ(reader.get(1), 1u);
  EXPECT_TRUE(reader.at_end());
  EXPECT_FALSE(reader.failed());
  reader.get(5);
  EXPECT_TRUE(reader.failed());
}

}  // namespace
}  // namespace pmesh
