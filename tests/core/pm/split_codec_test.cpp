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

FileHeader header_with_borders() {
  FileHeader header;
  header.lattice.bits = 10;
  header.has_borders = true;
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

TEST(SplitCodec, GivesBackEveryKindOfSplit) {
  const FileHeader header = header_with_borders();
  RefinableMesh expected = *RefinableMesh::from_base(square());
  for (const VertexSplit& split : kSplits) ASSERT_TRUE(expected.append(split).ok());
  RefinableMesh mesh = *RefinableMesh::from_base(square());
  const Status decoded = decode_chunk(encode(kSplits, header), 3, header, mesh);
  ASSERT_TRUE(decoded.ok()) << decoded.error().message;
  EXPECT_EQ(mesh.snapshot().positions, expected.snapshot().positions);
  EXPECT_EQ(mesh.snapshot().triangles, expected.snapshot().triangles);
}

TEST(SplitCodec, PacksTheBitsThatTheSpecificationSays) {
  const FileHeader header = header_with_borders();
  // kind 1,0; half-edge 0 of 6 in 3 bits; moved 0 as 0,00; three differences with Rice parameter 6:
  // zigzag(50) = 100 -> 1 0 and 36 in 6 bits; zigzag(0) -> 0 and 000000; zigzag(10) = 20.
  const Bytes bytes = encode({kSplits[0]}, header);
  EXPECT_EQ(bytes, (Bytes{0x01, 0x91, 0x00, 0x14}));
}

TEST(SplitCodec, RefusesBytesTooFewOrTooMany) {
  const FileHeader header = header_with_borders();
  const Bytes whole = encode(kSplits, header);
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

TEST(SplitCodec, RefusesAPositionOffTheLattice) {
  const FileHeader header = header_with_borders();
  RefinableMesh mesh = *RefinableMesh::from_base(square());
  BitWriter bits;
  bits.put(1, 2);                // border_first
  bits.put(0, 3 + 3);            // half-edge 0, no moved face
  bits.put((1u << 24) - 1, 24);  // escape: the value itself
  bits.put(zigzag(-1), 32);
  bits.put(0, 7);
  bits.put(0, 7);
  EXPECT_EQ(decode_chunk(std::move(bits).finish(), 1, header, mesh).error().message,
            "split 0: the new vertex lies off the lattice");
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
