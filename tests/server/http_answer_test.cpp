#include "server/http/http_answer.h"

#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/server/captured_log.h"
#include "tests/server/descriptor_limit.h"
#include "tests/server/http_answer_fixture.h"

namespace pmesh {
namespace {

using nlohmann::json;
using testing::HttpAnswerTest;
using testing::make_sample;
using testing::SampleFile;

TEST_F(HttpAnswerTest, SamplesHaveTheHashesThatTheFuzzSeedsName) {
  EXPECT_EQ(bunny_.hash(), "1f44ae592f2b1a71c99d060b076f08aa");
  EXPECT_EQ(measured_.hash(), "8b2c2930957fbc38e647cf2cc19ff620");
}

TEST_F(HttpAnswerTest, CatalogueListsTheMeshes) {
  const HttpAnswer answer = get("/catalog");
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.fields.find("Content-Type"), "application/json");
  EXPECT_EQ(answer.fields.find("Cache-Control"), "no-cache");
  EXPECT_EQ(json::parse(answer.body())[0]["hash"], bunny_.hash());
}

TEST_F(HttpAnswerTest, CatalogueIsOneTextForAllWhoAsk) {
  const HttpAnswer first = get("/catalog"), second = get("/catalog", {.method = "HEAD"});
  EXPECT_EQ(first.body().data(), second.body().data());
  EXPECT_EQ(first.fields.find("ETag"), second.fields.find("ETag"));
}

TEST_F(HttpAnswerTest, CatalogueHasATagForEachStateOfTheMeshes) {
  const HttpAnswer before = get("/catalog");
  const std::string tag(before.fields.find("ETag"));
  const HttpAnswer same = get("/catalog", {.if_none_match = tag});
  EXPECT_EQ(same.status, 304);
  EXPECT_EQ(same.body_bytes(), 0u);
  EXPECT_EQ(same.fields.find("ETag"), tag);

  directory_.write("third.pmesh", make_sample({100}, 3).bytes);
  const HttpAnswer more = get("/catalog", {.if_none_match = tag});
  EXPECT_EQ(more.status, 200);
  EXPECT_EQ(json::parse(more.body()).size(), 3u);
  EXPECT_EQ(json::parse(before.body()).size(), 2u);  // as whoever is being sent it needs it

  std::filesystem::remove(directory_ / "third.pmesh");
  EXPECT_EQ(get("/catalog", {.if_none_match = tag}).status, 304);
}

TEST_F(HttpAnswerTest, HealthIsNeverStored) {
  const HttpAnswer answer = get("/health");
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.fields.find("Cache-Control"), "no-store");
}

TEST_F(HttpAnswerTest, MeshInfoIsRevalidated) {
  const HttpAnswer answer = get("/bunny");
  EXPECT_EQ(json::parse(answer.text)["url"], file());
  EXPECT_EQ(answer.fields.find("Cache-Control"), "no-cache");
  const std::string tag(answer.fields.find("ETag"));
  EXPECT_EQ(get("/bunny", {.if_none_match = tag}).status, 304);
  EXPECT_EQ(get("/bunny", {.if_none_match = "\"other\""}).status, 200);
}

TEST_F(HttpAnswerTest, FileIsWholeAndForEver) {
  const HttpAnswer answer = get(file());
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.span, (ByteSpan{0, size_}));
  EXPECT_EQ(answer.fields.find("ETag"), etag());
  EXPECT_EQ(answer.fields.find("Accept-Ranges"), "bytes");
  EXPECT_EQ(answer.fields.find("Content-Location"), "");
  EXPECT_NE(answer.fields.find("Cache-Control").find("immutable"), std::string::npos);
  EXPECT_NE(answer.fields.find("Cache-Control").find("no-transform"), std::string::npos);
}

TEST_F(HttpAnswerTest, UnknownNamesAndHashesAreNotFound) {
  const std::string other(32, '0');
  for (const std::string& target :
       {std::string("//"), std::string("/nobody"), "/bunny/" + other + ".pmesh",
        "/nobody/" + bunny_.hash() + ".pmesh", "/bunny/" + other + "/c/0",
        "/bunny/" + bunny_.hash() + "/c/3", std::string("/../bunny"), std::string("/bunny/")}) {
    EXPECT_EQ(get(target).status, 404) << target;
  }
}

TEST_F(HttpAnswerTest, RangeGivesPart) {
  const HttpAnswer answer = get(file(), {.range = "bytes=10-19"});
  EXPECT_EQ(answer.status, 206);
  EXPECT_EQ(answer.span, (ByteSpan{10, 20}));
  EXPECT_EQ(answer.fields.find("Content-Range"), "bytes 10-19/" + std::to_string(size_));
}

TEST_F(HttpAnswerTest, RangeBeyondTheEndIsNotSatisfiable) {
  const std::string range = "bytes=" + std::to_string(size_) + "-";
  const HttpAnswer answer = get(file(), {.range = range});
  EXPECT_EQ(answer.status, 416);
  EXPECT_EQ(answer.mesh, nullptr);
  EXPECT_EQ(answer.fields.find("Content-Range"), "bytes */" + std::to_string(size_));
}

TEST_F(HttpAnswerTest, SeveralRangesGiveTheWhole) {
  EXPECT_EQ(get(file(), {.range = "bytes=0-1,4-5"}).status, 200);
}

TEST_F(HttpAnswerTest, HeadIgnoresRangesAndHasNoBody) {
  const HttpAnswer answer = get(file(), {.method = "HEAD", .range = "bytes=0-1"});
  EXPECT_EQ(answer.status, 200);
  EXPECT_TRUE(answer.head_only);
  EXPECT_EQ(answer.body_bytes(), size_);
}

TEST_F(HttpAnswerTest, IfRangeNeedsTheSameStrongTag) {
  const std::string same = etag(), weak = "W/" + etag();
  EXPECT_EQ(get(file(), {.range = "bytes=0-1", .if_range = same}).status, 206);
  EXPECT_EQ(get(file(), {.range = "bytes=0-1", .if_range = weak}).status, 200);
  EXPECT_EQ(get(file(), {.range = "bytes=0-1", .if_range = "\"other\""}).status, 200);
  EXPECT_EQ(get(file(), {.range = "bytes=0-1", .if_range = "Sun, 06 Nov 1994 08:49:37 GMT"}).status,
            200);
}

TEST_F(HttpAnswerTest, IfNoneMatchTakesListsWeakTagsAndStars) {
  const std::string list = "\"a\", W/" + etag() + " , \"b\"";
  for (const std::string& tags : {list, std::string("*"), etag()}) {
    const HttpAnswer answer = get(file(), {.range = "bytes=0-1", .if_none_match = tags});
    EXPECT_EQ(answer.status, 304) << tags;
    EXPECT_FALSE(answer.may_have_body());
    EXPECT_EQ(answer.fields.find("ETag"), etag());
  }
}

TEST_F(HttpAnswerTest, WishGivesTheWholeChunkPrefix) {
  const HttpAnswer answer = get(file("?faces=40"));
  const std::string length = std::to_string(chunk_end(1));
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.span, (ByteSpan{0, chunk_end(1)}));
  EXPECT_EQ(answer.fields.find("ETag"), etag("-" + length));
  EXPECT_EQ(answer.fields.find("Content-Location"), file("?chunks=0-1"));
  EXPECT_EQ(answer.fields.find("PMesh-Faces"), "40");
  EXPECT_EQ(answer.fields.find("PMesh-Vertices"), "22");
  EXPECT_EQ(answer.fields.find("PMesh-Chunks"), "2");
  EXPECT_EQ(answer.fields.find("PMesh-Reached"), "1");
}

TEST_F(HttpAnswerTest, ContentLocationIsTheSameAnswer) {
  for (const char* query : {"?faces=40", "?vertices=21", "?ratio=0.5", "?bytes=100000", "?faces=1",
                            "?chunks=1-2", "?chunks=0-1"}) {
    const HttpAnswer wished = get(file(query));
    const HttpAnswer located = get(std::string(wished.fields.find("Content-Location")));
    EXPECT_EQ(located.span, wished.span) << query;
    EXPECT_EQ(located.fields.find("ETag"), wished.fields.find("ETag")) << query;
  }
}

TEST_F(HttpAnswerTest, WishBelowTheBaseGivesTheBase) {
  const HttpAnswer answer = get(file("?faces=3"));
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.span, (ByteSpan{0, bunny_.index.base_end()}));
  EXPECT_EQ(answer.fields.find("PMesh-Reached"), "0");
  EXPECT_EQ(answer.fields.find("PMesh-Chunks"), "0");
}

TEST_F(HttpAnswerTest, ErrorWishGivesTheFirstChunkEndNearEnough) {
  for (const char* query : {"?error=2.5", "?error=0.04%25", "?error=0.04%"}) {
    const HttpAnswer answer = get(measured_file(query));
    EXPECT_EQ(answer.status, 200) << query;
    EXPECT_EQ(answer.span, (ByteSpan{0, measured_.index.chunks[1].end()})) << query;
    EXPECT_EQ(answer.fields.find("Content-Location"), measured_file("?chunks=0-1"));
    EXPECT_EQ(answer.fields.find("PMesh-Reached"), "1");
  }
}

TEST_F(HttpAnswerTest, ErrorWishOutOfReachGivesTheWholeFile) {
  const HttpAnswer answer = get(measured_file("?error=0.5"));
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.span, (ByteSpan{0, measured_.bytes.size()}));
  EXPECT_EQ(answer.fields.find("Content-Location"), measured_file("?chunks=0-2"));
  EXPECT_EQ(answer.fields.find("PMesh-Reached"), "0");
}

TEST_F(HttpAnswerTest, ErrorWishNeedsMeasuredErrors) {
  const HttpAnswer answer = get(file("?error=2.5"));
  EXPECT_EQ(answer.status, 400);
  EXPECT_NE(answer.text.find("without measured errors"), std::string::npos);
}

TEST_F(HttpAnswerTest, RangeWorksWithinAWish) {
  const HttpAnswer answer = get(file("?chunks=1-2"), {.range = "bytes=5-"});
  EXPECT_EQ(answer.status, 206);
  EXPECT_EQ(answer.span, (ByteSpan{chunk_end(0) + 5, chunk_end(2)}));
  EXPECT_EQ(answer.fields.find("Content-Range"), "bytes 5-499/500");
}

TEST_F(HttpAnswerTest, BadWishesAreBadRequests) {
  for (const char* query : {"?faces=x", "?faces=1&bytes=2", "?ratio=2", "?chunks=0-3", "?x=1",
                            "?error=-1", "?error=nan", "?error=1e999", "?error=1%%"}) {
    EXPECT_EQ(get(file(query)).status, 400) << query;
    EXPECT_EQ(get(measured_file(query)).status, 400) << query;
  }
}

TEST_F(HttpAnswerTest, ChunkIsAPlainAnswer) {
  const HttpAnswer answer = get("/bunny/" + bunny_.hash() + "/c/1", {.range = "bytes=0-1"});
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.span, (ByteSpan{chunk_end(0), chunk_end(1)}));
  EXPECT_EQ(answer.fields.find("Accept-Ranges"), "none");
}

TEST_F(HttpAnswerTest, OtherMethodsAreNotAllowed) {
  for (const char* method : {"POST", "PUT", "DELETE", "TRACE", "CONNECT", "get", "BREW"}) {
    const HttpAnswer answer = get("/catalog", {.method = method});
    EXPECT_EQ(answer.status, 405) << method;
    EXPECT_EQ(answer.fields.find("Allow"), "GET, HEAD, OPTIONS");
  }
}

TEST_F(HttpAnswerTest, MalformedTargetsAreBadRequests) {
  EXPECT_EQ(get("/%zz").status, 400);
  EXPECT_EQ(get("catalog").status, 400);
}

TEST_F(HttpAnswerTest, EveryAnswerMayBeReadByOtherOrigins) {
  for (const std::string& target : {file(), std::string("/catalog"), std::string("/nobody"),
                                    std::string("/%"), std::string("/health")}) {
    const std::string head = head_text(get(target), "today", true);
    EXPECT_NE(head.find("\r\nAccess-Control-Allow-Origin: *\r\n"), std::string::npos) << target;
    const std::size_t exposed = head.find("\r\nAccess-Control-Expose-Headers: ");
    EXPECT_LT(head.find("Content-Range", exposed), head.find("\r\n", exposed + 2));
  }
}

TEST_F(HttpAnswerTest, PreflightAllowsRanges) {
  const HttpAnswer answer = get(file(), {.method = "OPTIONS"});
  EXPECT_EQ(answer.status, 204);
  EXPECT_NE(answer.fields.find("Access-Control-Allow-Headers").find("Range"), std::string::npos);
}

TEST_F(HttpAnswerTest, ReplacedFileHasANewTag) {
  const std::string before(get("/bunny").fields.find("ETag"));
  const SampleFile other = make_sample({100, 200, 300}, 2);
  directory_.write("incoming", other.bytes);
  std::filesystem::rename(directory_ / "incoming", directory_ / "bunny.pmesh");
  EXPECT_EQ(get("/bunny", {.if_none_match = before}).status, 200);
  EXPECT_EQ(get(file()).status, 404);
  EXPECT_EQ(get("/bunny/" + other.hash() + ".pmesh").status, 200);
}

TEST_F(HttpAnswerTest, AMeshThatCannotBeOpenedNowIsToBeAskedForAgain) {
  if (!testing::DescriptorLimit::can_leave_none()) GTEST_SKIP() << "sanitizers need descriptors";
  directory_.write("late.pmesh", bunny_.bytes);
  const testing::CapturedLog log;
  const testing::DescriptorLimit limit(testing::DescriptorLimit::none_left());
  for (const std::string& target : {std::string("/late"), "/late/" + bunny_.hash() + ".pmesh",
                                    "/late/" + bunny_.hash() + "/c/0"}) {
    const HttpAnswer answer = get(target);
    EXPECT_EQ(answer.status, 503) << target;
    EXPECT_EQ(answer.fields.find("Retry-After"), "1");
    EXPECT_EQ(answer.fields.find("Cache-Control"), "no-store");
  }
  EXPECT_EQ(get("/nobody").status, 404);
}

TEST_F(HttpAnswerTest, HeadTextIsTheWholeHead) {
  HttpAnswer answer;
  answer.status = 206;
  answer.fields.add("ETag", "\"x\"");
  answer.text = "abc";
  const std::string head = head_text(answer, "today", true);
  EXPECT_TRUE(head.starts_with("HTTP/1.1 206 Partial Content\r\nDate: today\r\n"));
  EXPECT_TRUE(
      head.ends_with("\r\nETag: \"x\"\r\nContent-Length: 3\r\nConnection: keep-alive\r\n\r\n"));
  answer.status = 304;
  EXPECT_EQ(head_text(answer, "today", false).find("Content-Length: "), std::string::npos);
}

TEST_F(HttpAnswerTest, ManyRangesAreRefused) {
  EXPECT_EQ(get(file(), {.range = "bytes=0-1,2-3,4-5,6-7,8-9,10-11,12-13,14-15"}).status, 200);
  const HttpAnswer answer =
      get(file(), {.range = "bytes=0-1,2-3,4-5,6-7,8-9,10-11,12-13,14-15,16-17"});
  EXPECT_EQ(answer.status, 416);
  EXPECT_EQ(answer.limit, LimitName::ranges);
}

TEST_F(HttpAnswerTest, StreamsAreForWebSockets) {
  EXPECT_EQ(get("/bunny/stream").status, 426);
  const HttpAnswer answer = get("/bunny/stream", {.upgrade = true});
  EXPECT_EQ(answer.status, 101);
  EXPECT_EQ(answer.stream_id, "bunny");
  EXPECT_EQ(get("/nobody/stream", {.upgrade = true}).status, 404);
}

TEST_F(HttpAnswerTest, PagesAndDescriptionAreThere) {
  EXPECT_EQ(get("/").fields.find("Content-Type"), "text/html; charset=utf-8");
  EXPECT_EQ(get("/view/bunny").status, 200);
  EXPECT_EQ(get("/view/nobody").status, 404);
  EXPECT_TRUE(json::parse(get("/openapi.json").text).contains("openapi"));
}

TEST_F(HttpAnswerTest, MetricsMayBeServedElsewhere) {
  EXPECT_EQ(get("/metrics").text, "metrics");
  EXPECT_EQ(get("/metrics").fields.find("Cache-Control"), "no-store");
  site_.metrics_text = {};
  EXPECT_EQ(get("/metrics").status, 404);
}

TEST_F(HttpAnswerTest, TheMetricsPortServesNothingElse) {
  site_.set_access({.tokens = {"0123456789abcdef"}, .url_key = {}});
  const auto answer_to = [&](std::string_view target) {
    HttpContext context = site_.context();
    context.only_operation = true;
    return answer_http({.method = "GET", .target = target}, context).status;
  };
  EXPECT_EQ(answer_to("/metrics"), 200);
  EXPECT_EQ(answer_to("/health"), 200);
  EXPECT_EQ(answer_to("/catalog"), 404);
  EXPECT_EQ(answer_to("/bunny"), 404);
}

}  // namespace
}  // namespace pmesh
