#include "protocol/routes.h"

#include <gtest/gtest.h>

namespace pmesh {
namespace {

constexpr char kHash[] = "00112233445566778899aabbccddeeff";

const ContentHash kHashBytes = {0x00, 0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77,
                                0x88, 0x99, 0xAA, 0xBB, 0xCC, 0xDD, 0xEE, 0xFF};

Route route(const std::string& target) { return parse_target(target).value(); }

std::string hashed(const std::string& before, const std::string& after) {
  return before + kHash + after;
}

TEST(Routes, KnowsTheFixedNames) {
  EXPECT_EQ(route("/catalog"), Route(CatalogRoute{}));
  EXPECT_EQ(route("/health?probe=1"), Route(HealthRoute{}));
}

TEST(Routes, KnowsAMesh) {
  EXPECT_EQ(route("/scans~bunny"), Route(MeshInfoRoute{"scans~bunny"}));
  EXPECT_EQ(route("/bunny?x"), Route(MeshInfoRoute{"bunny"}));
}

TEST(Routes, KnowsAFileWithAndWithoutAWish) {
  EXPECT_EQ(route(hashed("/bunny/", ".pmesh")), Route(MeshFileRoute{"bunny", kHashBytes, {}}));
  const LodRequest wish{.kind = WishKind::faces, .count = 5};
  EXPECT_EQ(route(hashed("/bunny/", ".pmesh?faces=5")),
            Route(MeshFileRoute{"bunny", kHashBytes, wish}));
}

TEST(Routes, KnowsAChunk) {
  EXPECT_EQ(route(hashed("/bunny/", "/c/12")), Route(ChunkRoute{"bunny", kHashBytes, 12}));
}

TEST(Routes, DecodesPercentEscapesAfterCuttingThePath) {
  EXPECT_EQ(route("/b%75nny"), Route(MeshInfoRoute{"bunny"}));
  EXPECT_EQ(route("/scans%7Ebunny"), Route(MeshInfoRoute{"scans~bunny"}));
  EXPECT_EQ(route("/a%2Fb"), Route(UnknownRoute{}));
  EXPECT_EQ(route("/%2e%2e"), Route(UnknownRoute{}));
  EXPECT_EQ(route("/a%00b"), Route(UnknownRoute{}));
}

TEST(Routes, TakesTheAbsoluteForm) {
  EXPECT_EQ(route("http://host:8080/catalog"), Route(CatalogRoute{}));
  EXPECT_EQ(route("http://host"), Route(ViewerRoute{}));
  EXPECT_EQ(route("HTTP://host/catalog"), Route(CatalogRoute{}));
  EXPECT_EQ(route("Https://host/catalog"), Route(CatalogRoute{}));
}

TEST(Routes, DoesNotKnowOtherPaths) {
  for (const char* target :
       {"//", "//catalog", "/catalog/", "/./catalog", "/../etc/passwd", "/bunny/", "/bunny/c/1",
        "/a/b/c/d/e/f/g", "/metrics/", "/bunny//", "/view", "/view/", "/view/../x", "/view/bunny/x",
        "/bunny/lod.exe", "/bunny/lod.", "/bunny/stream/", "/catalog/lod.glb", "/assets/x.js"}) {
    EXPECT_EQ(route(target), Route(UnknownRoute{})) << target;
  }
}

TEST(Routes, KnowsPagesAndOperation) {
  EXPECT_EQ(route("/"), Route(ViewerRoute{}));
  EXPECT_EQ(route("/view/scans~bunny"), Route(ViewerRoute{"scans~bunny"}));
  EXPECT_EQ(route("/metrics"), Route(MetricsRoute{}));
  EXPECT_EQ(route("/openapi.json?x"), Route(OpenapiRoute{}));
  EXPECT_EQ(route("/bunny/stream"), Route(StreamRoute{"bunny"}));
}

TEST(Routes, ReadsFinishedLevels) {
  const LodRequest faces = parse_wish("faces=100").value();
  EXPECT_EQ(route("/bunny/lod.ply"), Route(LodRoute{"bunny", LodFormat::ply, {}}));
  for (const char* query : {"faces=100&draco=1", "draco=1&faces=100", "%66aces=100&draco=1"}) {
    EXPECT_EQ(route(std::string("/bunny/lod.glb?") + query),
              Route(LodRoute{"bunny", LodFormat::glb_draco, faces}))
        << query;
  }
  EXPECT_EQ(route("/bunny/lod.glb?draco=0"), Route(LodRoute{"bunny", LodFormat::glb, {}}));
  EXPECT_EQ(route("/bunny/lod.glb?draco=1"), Route(LodRoute{"bunny", LodFormat::glb_draco, {}}));
  for (const char* query :
       {"draco=", "draco=2", "draco=1&draco=1", "faces=1&faces=2", "x=1", "faces=100&", "%zz"}) {
    EXPECT_FALSE(parse_target(std::string("/bunny/lod.glb?") + query).ok()) << query;
  }
}

TEST(Routes, DoesNotKnowAHashThatIsNotOne) {
  EXPECT_EQ(route("/bunny/0011.pmesh"), Route(UnknownRoute{}));
  EXPECT_EQ(route("/bunny/00112233445566778899AABBCCDDEEFF.pmesh"), Route(UnknownRoute{}));
  EXPECT_EQ(route(hashed("/bunny/", ".ply")), Route(UnknownRoute{}));
  EXPECT_EQ(route(hashed("/bunny/", "/c/x")), Route(UnknownRoute{}));
  EXPECT_EQ(route(hashed("/bunny/", "/c/99999999999999999999")), Route(UnknownRoute{}));
}

TEST(Routes, RejectsBrokenEscapes) {
  for (const char* target : {"/%", "/%4", "/%4g", "/bunny%", "/a/b/%zz"}) {
    EXPECT_FALSE(parse_target(target).ok()) << target;
  }
}

TEST(Routes, RejectsBadWishes) {
  EXPECT_FALSE(parse_target(hashed("/bunny/", ".pmesh?faces=x")).ok());
  EXPECT_FALSE(parse_target(hashed("/bunny/", ".pmesh?faces=1&bytes=2")).ok());
  for (const char* query :
       {"faces=%", "faces=5%", "error=%", "error=1%%", "error=1%2", "error=1%25%", "error=%1"}) {
    EXPECT_FALSE(parse_target(hashed("/bunny/", ".pmesh?").append(query)).ok()) << query;
  }
}

TEST(Routes, TakesAPercentSignEscapedOrAtTheEnd) {
  const LodRequest wish{.kind = WishKind::error, .error = 0.1, .error_is_percent = true};
  for (const char* query : {"error=0.1%25", "error=0.1%", "error%3D0.1%25"}) {
    EXPECT_EQ(route(hashed("/bunny/", ".pmesh?").append(query)),
              Route(MeshFileRoute{"bunny", kHashBytes, wish}))
        << query;
  }
  EXPECT_EQ(file_target("bunny", kHashBytes, wish), hashed("/bunny/", ".pmesh?error=0.1%25"));
}

TEST(Routes, RejectsOtherFormsOfTarget) {
  for (const char* target : {"", "*", "host:80", "catalog", "ftp://host/catalog"}) {
    EXPECT_FALSE(parse_target(target).ok()) << target;
  }
}

TEST(Routes, WritesTheTargetItReads) {
  const LodRequest wish{.kind = WishKind::ratio, .ratio = 0.25};
  EXPECT_EQ(file_target("bunny", kHashBytes, wish), hashed("/bunny/", ".pmesh?ratio=0.25"));
  EXPECT_EQ(file_target("bunny", kHashBytes), hashed("/bunny/", ".pmesh"));
  EXPECT_EQ(chunk_target("bunny", kHashBytes, 7), hashed("/bunny/", "/c/7"));
}

}  // namespace
}  // namespace pmesh
