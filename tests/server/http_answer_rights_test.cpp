// Answers that depend on more than the request: finished levels of detail, and who may have what.
#include "server/access/signed_query.h"
#include "server/http/http_answer.h"
#include "tests/server/http_answer_fixture.h"

namespace pmesh {
namespace {

using testing::HttpAnswerTest;

TEST_F(HttpAnswerTest, FinishedLevelsAreAJobBeforeTheyAreAnAnswer) {
  HttpAnswer answer = get("/bunny/lod.glb?faces=20&draco=1");
  ASSERT_TRUE(answer.lod_job);
  EXPECT_EQ(answer.lod_job->format, LodFormat::glb_draco);
  EXPECT_EQ(answer.lod_job->wish, parse_wish("faces=20").value());
  EXPECT_EQ(answer.fields.find("Content-Type"), "model/gltf-binary");
  EXPECT_EQ(answer.fields.find("Cache-Control"), "no-cache");

  const auto file = std::make_shared<const LodFile>(LodFile{{1, 2, 3}, 20, 12, true});
  take_lod(answer, {LodFilePtr(file)});
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.body_bytes(), 3u);
  EXPECT_EQ(answer.body().data(), file->bytes.data());
  EXPECT_EQ(answer.fields.find("PMesh-Faces"), "20");
  EXPECT_EQ(answer.fields.find("PMesh-Reached"), "1");
}

TEST_F(HttpAnswerTest, FinishedLevelsThatAreKnownAreNotMade) {
  const std::string tag(get("/bunny/lod.ply?faces=20").fields.find("ETag"));
  const HttpAnswer answer = get("/bunny/lod.ply?faces=20", {.if_none_match = tag});
  EXPECT_EQ(answer.status, 304);
  EXPECT_FALSE(answer.lod_job);
  EXPECT_NE(get("/bunny/lod.ply?faces=40").fields.find("ETag"), tag);
  EXPECT_NE(get("/bunny/lod.obj?faces=20").fields.find("ETag"), tag);
}

TEST_F(HttpAnswerTest, FinishedLevelsThatCannotBeMadeAreErrors) {
  HttpAnswer busy = get("/bunny/lod.ply");
  take_lod(busy, {Error{ErrorCode::out_of_resources, "full"}, LimitName::lod_per_address});
  EXPECT_EQ(busy.status, 503);
  EXPECT_EQ(busy.fields.find("Retry-After"), "1");
  EXPECT_EQ(busy.limit, LimitName::lod_per_address);
  HttpAnswer failed = get("/bunny/lod.ply");
  take_lod(failed, {Error{ErrorCode::verification, "/secret/path: altered"}});
  EXPECT_EQ(failed.status, 500);
  EXPECT_FALSE(failed.limit);
  EXPECT_EQ(failed.text.find("secret"), std::string::npos);
}

TEST_F(HttpAnswerTest, FinishedLevelsHaveAMostOfFaces) {
  site_.most_lod_faces = 20;
  EXPECT_TRUE(get("/bunny/lod.ply?faces=20").lod_job);
  const HttpAnswer answer = get("/bunny/lod.ply");
  EXPECT_EQ(answer.status, 400);
  EXPECT_EQ(answer.limit, LimitName::lod_faces);
}

TEST_F(HttpAnswerTest, BadLevelsAreBadRequests) {
  for (const char* query :
       {"?faces=x", "?draco=2", "?draco=1&draco=1", "?chunks=1-2", "?faces=1&draco=1&faces=2"}) {
    EXPECT_EQ(get(std::string("/bunny/lod.glb") + query).status, 400) << query;
  }
  EXPECT_EQ(get("/bunny/lod.exe").status, 404);
  EXPECT_EQ(get("/nobody/lod.glb").status, 404);
}

class AccessAnswerTest : public HttpAnswerTest {
 protected:
  static constexpr std::string_view kToken = "Bearer 0123456789abcdef";
  static constexpr std::string_view kKey = "an url key of thirty-two letters";

  void SetUp() override {
    HttpAnswerTest::SetUp();
    site_.set_access({.tokens = {"0123456789abcdef"}, .url_key = std::string(kKey)});
  }
};

TEST_F(AccessAnswerTest, WithoutATokenOnlyHealthAndPagesAreServed) {
  for (const std::string& target :
       {std::string("/catalog"), std::string("/bunny"), file(), file("?faces=20"),
        "/bunny/" + bunny_.hash() + "/c/0", std::string("/bunny/lod.glb"),
        std::string("/bunny/stream"), std::string("/metrics"), std::string("/nobody")}) {
    const HttpAnswer answer = get(target, {.upgrade = true});
    EXPECT_EQ(answer.status, 401) << target;
    EXPECT_EQ(answer.fields.find("WWW-Authenticate"), kChallenge);
    EXPECT_EQ(answer.limit, LimitName::access);
  }
  for (const char* target : {"/health", "/", "/openapi.json"}) {
    EXPECT_EQ(get(target).status, 200) << target;
  }
}

TEST_F(AccessAnswerTest, APageDoesNotTellWhatIsThere) {
  EXPECT_EQ(get("/view/bunny").status, get("/view/nobody").status);
}

TEST_F(AccessAnswerTest, ATokenOpensEverythingToItsBearerAlone) {
  EXPECT_EQ(get("/catalog", {.authorization = kToken}).status, 200);
  const HttpAnswer answer = get(file(), {.authorization = kToken});
  EXPECT_EQ(answer.status, 200);
  EXPECT_TRUE(answer.fields.find("Cache-Control").starts_with("private, "));
  EXPECT_EQ(get("/catalog", {.authorization = "Bearer 0123456789abcdeX"}).status, 401);
}

TEST_F(AccessAnswerTest, ASignatureOpensOneMeshForSomeTime) {
  const std::string query = sign_query(kKey, "bunny", site_.now + 10);
  EXPECT_EQ(get("/bunny?" + query).status, 200);
  const HttpAnswer level = get(file("?faces=20&" + query));
  EXPECT_EQ(level.status, 200);
  EXPECT_EQ(level.fields.find("Content-Location").find("signature"), std::string::npos);
  EXPECT_EQ(get(file("?" + query + "&bytes=600")).span, get(file("?bytes=600&" + query)).span);
  EXPECT_TRUE(get("/bunny/lod.glb?draco=1&" + query + "&faces=20").lod_job);
  EXPECT_EQ(get("/measured?" + query).status, 403);
  EXPECT_EQ(get("/catalog?" + query).status, 403);
  site_.now += 11;
  EXPECT_EQ(get("/bunny?" + query).status, 403);
}

}  // namespace
}  // namespace pmesh
