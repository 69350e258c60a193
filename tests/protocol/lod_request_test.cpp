#include "protocol/lod_request.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/protocol/sample_index.h"

namespace pmesh {
namespace {

using testing::sample_index;
using testing::sample_index_with_arrivals;
using testing::sample_index_with_borders;
using testing::sample_index_with_errors;

Resolution resolved(std::string_view query, const FileIndex& index = sample_index()) {
  return resolve(parse_wish(query).value(), index).value();
}

TEST(ParseWish, ReadsEveryKind) {
  EXPECT_EQ(parse_wish("").value(), LodRequest{});
  EXPECT_EQ(parse_wish("faces=9").value(), (LodRequest{.kind = WishKind::faces, .count = 9}));
  EXPECT_EQ(parse_wish("vertices=9").value(), (LodRequest{.kind = WishKind::vertices, .count = 9}));
  EXPECT_EQ(parse_wish("bytes=9").value(), (LodRequest{.kind = WishKind::bytes, .count = 9}));
  EXPECT_EQ(parse_wish("ratio=0.5").value(), (LodRequest{.kind = WishKind::ratio, .ratio = 0.5}));
  EXPECT_EQ(parse_wish("error=0.25").value(), (LodRequest{.kind = WishKind::error, .error = 0.25}));
  EXPECT_EQ(parse_wish("error=0.1%").value(),
            (LodRequest{.kind = WishKind::error, .error = 0.1, .error_is_percent = true}));
  EXPECT_EQ(parse_wish("chunks=2-7").value(),
            (LodRequest{.kind = WishKind::chunks, .first_chunk = 2, .last_chunk = 7}));
}

TEST(ParseWish, ReadsBackItsOwnSpelling) {
  for (const char* query :
       {"", "faces=18446744073709551615", "vertices=0", "bytes=65536", "ratio=0.05", "ratio=1e-09",
        "ratio=1", "chunks=0-3", "error=0", "error=0.1", "error=0.1%", "error=0%", "error=5e-324",
        "error=1e+300%"}) {
    EXPECT_EQ(to_query(parse_wish(query).value()), query);
  }
}

TEST(ParseWish, RejectsMalformedWishes) {
  for (const char* query :
       {"faces", "faces=", "=5", "faces=5x", "faces= 5", "faces=-5", "faces=+5", "faces=1.5",
        "faces=18446744073709551616", "Faces=5", "errors=1", "chunks=3", "chunks=3-", "chunks=-3",
        "chunks=3-2", "chunks=1-2-3", "?faces=5", "faces==5"}) {
    ASSERT_FALSE(parse_wish(query).ok()) << query;
    EXPECT_EQ(parse_wish(query).error().code, ErrorCode::usage);
  }
}

TEST(ParseWish, RejectsTwoWishes) {
  EXPECT_FALSE(parse_wish("faces=5&bytes=6").ok());
  EXPECT_FALSE(parse_wish("faces=5&").ok());
}

TEST(ParseWish, RejectsRatiosOutsideZeroToOne) {
  for (const char* query : {"ratio=0", "ratio=-0.5", "ratio=1.001", "ratio=nan", "ratio=inf",
                            "ratio=1e-999", "ratio=0x1p-1", "ratio="}) {
    EXPECT_FALSE(parse_wish(query).ok()) << query;
  }
}

TEST(ParseWish, ReadsBackEveryErrorItCanHold) {
  for (const double error : {0.1, 1.0 / 3, 1e-308, 1.7976931348623157e308}) {
    for (const bool is_percent : {false, true}) {
      const LodRequest wish{
          .kind = WishKind::error, .error = error, .error_is_percent = is_percent};
      EXPECT_EQ(parse_wish(to_query(wish)).value(), wish) << to_query(wish);
    }
  }
}

TEST(ParseWish, RejectsErrorsThatAreNoDistance) {
  for (const char* query :
       {"error=", "error=%", "error=-1", "error=-0.1%", "error=nan", "error=inf", "error=1e999",
        "error=1%%", "error=1 %", "error=1mm", "error=%1", "error=+1"}) {
    ASSERT_FALSE(parse_wish(query).ok()) << query;
    EXPECT_NE(parse_wish(query).error().message.find("at least 0"), std::string::npos);
  }
}

TEST(Resolve, EverythingIsTheWholeFile) {
  EXPECT_EQ(resolved(""), (Resolution{.end = 240, .chunk_count = 3, .faces = 80, .vertices = 42}));
}

TEST(Resolve, FacesAtAChunksEndNeedNoFurtherChunk) {
  EXPECT_EQ(resolved("faces=10"),
            (Resolution{.end = 150, .chunk_count = 0, .faces = 10, .vertices = 7}));
  EXPECT_EQ(resolved("faces=20"),
            (Resolution{.end = 170, .chunk_count = 1, .faces = 20, .vertices = 12}));
}

TEST(Resolve, FacesInsideAChunkNeedItWhole) {
  EXPECT_EQ(resolved("faces=22"),
            (Resolution{.end = 200, .chunk_count = 2, .faces = 22, .vertices = 13}));
  EXPECT_EQ(resolved("faces=39"),
            (Resolution{.end = 200, .chunk_count = 2, .faces = 38, .vertices = 21}));
}

TEST(Resolve, OneSpareFaceIsNoSplitWithoutBorders) {
  EXPECT_EQ(resolved("faces=21"), resolved("faces=20"));
}

TEST(Resolve, OneSpareFaceMayBeABorderSplit) {
  EXPECT_EQ(resolved("faces=21", sample_index_with_borders()),
            (Resolution{.end = 200, .chunk_count = 2, .faces = 21, .vertices = 13}));
}

TEST(Resolve, BordersGiveUpperBounds) {
  const FileIndex index = sample_index_with_borders();
  EXPECT_EQ(resolved("faces=27", index),  // 4 border splits and 1 inside at most
            (Resolution{.end = 200, .chunk_count = 2, .faces = 27, .vertices = 17}));
  EXPECT_EQ(resolved("vertices=20", index),  // 6 splits inside and 2 on the border at most
            (Resolution{.end = 200, .chunk_count = 2, .faces = 34, .vertices = 20}));
}

TEST(Resolve, NewComponentsComeWholeOrNotAtAll) {
  const FileIndex index = sample_index_with_arrivals();
  const Resolution without{.end = 170, .chunk_count = 1, .faces = 20, .vertices = 12};
  const Resolution with{.end = 200, .chunk_count = 2, .faces = 28, .vertices = 16};
  EXPECT_EQ(resolved("faces=27", index), without);
  EXPECT_EQ(resolved("vertices=15", index), without);
  EXPECT_EQ(resolved("faces=28", index), with);
  EXPECT_EQ(resolved("faces=29", index), with);
  EXPECT_EQ(resolved("vertices=16", index), with);
}

TEST(Resolve, SplitsFollowNewComponents) {
  const Resolution lod{.end = 200, .chunk_count = 2, .faces = 32, .vertices = 18};
  EXPECT_EQ(resolved("faces=33", sample_index_with_arrivals()), lod);
  EXPECT_EQ(resolved("vertices=18", sample_index_with_arrivals()), lod);
}

TEST(Resolve, MoreThanTheMeshHasIsTheWholeFile) {
  EXPECT_EQ(resolved("faces=18446744073709551615"), resolved(""));
  EXPECT_EQ(resolved("vertices=18446744073709551615"), resolved(""));
  EXPECT_EQ(resolved("bytes=18446744073709551615"), resolved(""));
  EXPECT_EQ(resolved("ratio=1"), resolved(""));
}

TEST(Resolve, LessThanTheBaseIsTheBase) {
  const Resolution base{.end = 150, .faces = 10, .vertices = 7, .reached = false};
  EXPECT_EQ(resolved("faces=9"), base);
  EXPECT_EQ(resolved("vertices=0"), base);
  EXPECT_EQ(resolved("bytes=149"), base);
  EXPECT_EQ(resolved("ratio=0.001"), base);
}

TEST(Resolve, VerticesAreExact) {
  EXPECT_EQ(resolved("vertices=13"),
            (Resolution{.end = 200, .chunk_count = 2, .faces = 22, .vertices = 13}));
  EXPECT_EQ(resolved("vertices=22"), resolved("faces=40"));
}

TEST(Resolve, RatioRoundsDown) { EXPECT_EQ(resolved("ratio=0.2874"), resolved("faces=22")); }

TEST(Resolve, ErrorIsTheFirstChunkEndNearEnough) {
  const FileIndex index = sample_index_with_errors();
  EXPECT_EQ(resolved("error=9", index), resolved("faces=20"));
  EXPECT_EQ(resolved("error=4", index), resolved("faces=20"));
  EXPECT_EQ(resolved("error=3.9", index), resolved("faces=40"));
  EXPECT_EQ(resolved("error=1", index), resolved("faces=40"));
}

TEST(Resolve, ErrorsNeedNotFallFromRowToRow) {
  FileIndex index = sample_index();
  set_errors(index, {2, 4, 1});
  EXPECT_EQ(resolved("error=3", index), resolved("faces=20"));
  EXPECT_EQ(resolved("error=1", index), resolved("faces=80"));
}

TEST(Resolve, AnErrorInPercentIsOfTheDiagonal) {
  const FileIndex index = sample_index_with_errors();
  EXPECT_DOUBLE_EQ(index.header.box_diagonal(), std::sqrt(5.0));
  EXPECT_EQ(resolved("error=179%", index), resolved("error=4", index));
  EXPECT_EQ(resolved("error=178%", index), resolved("error=1", index));
  EXPECT_EQ(resolved("error=1e308%", index), resolved("error=4", index));
}

TEST(Resolve, AnErrorThatNoChunkReachesIsTheWholeFile) {
  Resolution finest = resolved("");
  finest.reached = false;
  EXPECT_EQ(resolved("error=0.99", sample_index_with_errors()), finest);
  EXPECT_EQ(resolved("error=0", sample_index_with_errors()), finest);
}

TEST(Resolve, AFileWithoutChunksHasNoErrorToReach) {
  FileIndex index = sample_index();
  index.chunks.clear();
  index.header.errors_measured = true;
  index.header.file_bytes = index.base_end();
  EXPECT_EQ(
      resolved("error=9", index),
      (Resolution{.end = 150, .chunk_count = 0, .faces = 10, .vertices = 7, .reached = false}));
}

TEST(Resolve, RejectsErrorsThatWereNotMeasured) {
  FileIndex index = sample_index_with_errors();
  index.header.errors_measured = false;
  const auto resolution = resolve(parse_wish("error=9").value(), index);
  ASSERT_FALSE(resolution.ok());
  EXPECT_EQ(resolution.error().code, ErrorCode::usage);
  EXPECT_NE(resolution.error().message.find("without measured errors"), std::string::npos);
}

TEST(Resolve, BytesAreTheLargestWholePrefix) {
  EXPECT_EQ(resolved("bytes=199"), resolved("faces=20"));
  EXPECT_EQ(resolved("bytes=200"), resolved("faces=40"));
}

TEST(Resolve, ChunkWishesAreAdjoiningPieces) {
  EXPECT_EQ(resolved("chunks=0-0").begin, 0u);
  EXPECT_EQ(resolved("chunks=0-0").end, 170u);
  EXPECT_EQ(resolved("chunks=1-2"),
            (Resolution{.begin = 170, .end = 240, .chunk_count = 3, .faces = 80, .vertices = 42}));
}

TEST(Resolve, RejectsChunksBeyondTheFile) {
  EXPECT_FALSE(resolve(parse_wish("chunks=0-3").value(), sample_index()).ok());
  EXPECT_FALSE(resolve(parse_wish("chunks=9-18446744073709551615").value(), sample_index()).ok());
}

}  // namespace
}  // namespace pmesh
