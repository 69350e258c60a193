// The client against web hosts on the loopback, good and bad.
#include <algorithm>
#include <chrono>

#include <gtest/gtest.h>

#include "tests/client/fetched.h"
#include "tests/client/loopback.h"
#include "tests/client/sample.h"
#include "tests/client/scripted_transport.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

using test::Fetched;
using test::HttpHost;
using test::kImpatient;
using test::random_cuts;
using test::sample_file;
using test::sample_index;
using test::wish;

TEST(HttpTransport, FetchesAFileByRangesOverOneConnection) {
  HttpHost host(sample_file(), {});
  const Fetched fetched(host.url());
  EXPECT_EQ(fetched.error(), "");
  EXPECT_TRUE(fetched.is_sample());
  EXPECT_EQ(host.connections(), 1);
  EXPECT_EQ(host.ranges(),
            (std::vector<std::string>{"bytes=0-16383",
                                      "bytes=16384-" + std::to_string(sample_file().size() - 1)}));
}

TEST(HttpTransport, FetchesNoMoreThanTheWishNeeds) {
  HttpHost host(sample_file(), {});
  const Fetched fetched(host.url(), "faces=10000");
  EXPECT_EQ(fetched.error(), "");
  const std::uint64_t end = resolve(wish("faces=10000"), sample_index())->end;
  ASSERT_GT(end, kMaxPrologueBytes);
  EXPECT_EQ(fetched.client.bytes_fetched(), end);
}

TEST(HttpTransport, TakesAWholeFileWhereARangeWasAskedFor) {
  for (const bool chunked : {false, true}) {
    HttpHost host(sample_file(), {.ignores_ranges = true, .chunked = chunked});
    const Fetched fetched(host.url());
    EXPECT_EQ(fetched.error(), "");
    EXPECT_TRUE(fetched.is_sample());
    EXPECT_EQ(host.ranges().size(), 1u);
  }
}

TEST(HttpTransport, ReconnectsToAHostThatClosesAfterEveryResponse) {
  HttpHost host(sample_file(), {.keeps_alive = false});
  const Fetched fetched(host.url());
  EXPECT_EQ(fetched.error(), "");
  EXPECT_TRUE(fetched.is_sample());
  EXPECT_EQ(host.connections(), 2);
}

TEST(HttpTransport, SurvivesCutsAtRandomPlaces) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    HttpHost host(sample_file(), {.cut_after = random_cuts(seed, 9000)});
    const Fetched fetched(host.url());
    EXPECT_EQ(fetched.error(), "") << seed;
    EXPECT_TRUE(fetched.is_sample()) << seed;
    EXPECT_LE(fetched.client.bytes_fetched(),
              sample_file().size() + 40u * static_cast<unsigned>(host.connections()));
  }
}

TEST(HttpTransport, SurvivesCutsByAHostThatIgnoresRanges) {
  for (std::uint32_t seed = 0; seed < 5; ++seed) {
    HttpHost host(sample_file(), {.ignores_ranges = true, .cut_after = random_cuts(seed, 200'000)});
    const Fetched fetched(host.url());
    EXPECT_EQ(fetched.error(), "") << seed;
    EXPECT_TRUE(fetched.is_sample()) << seed;
  }
}

TEST(HttpTransport, WaitsOutAHostThatIsBusyForAMoment) {
  HttpHost host(sample_file(), {.failures = 4});
  const Fetched fetched(host.url());
  EXPECT_EQ(fetched.error(), "");
  EXPECT_TRUE(fetched.is_sample());
}

TEST(HttpTransport, GivesUpOnAHostThatStaysBusy) {
  HttpHost host(sample_file(), {.failures = 100});
  EXPECT_NE(Fetched(host.url()).error().find("503"), std::string::npos);
}

TEST(HttpTransport, LeavesAStalledResponseAndAsksAgain) {
  HttpHost host(sample_file(), {.stalls = 2});
  const Fetched fetched(host.url(), "", {.idle_timeout = kImpatient});
  EXPECT_EQ(fetched.error(), "");
  EXPECT_TRUE(fetched.is_sample());
}

TEST(HttpTransport, GivesUpOnAHostThatStallsForEver) {
  HttpHost host({},
                {.stalls = 100, .raw_answer = "HTTP/1.1 206 Partial Content\r\nContent-Length"});
  EXPECT_NE(Fetched(host.url(), "", {.idle_timeout = kImpatient}).error().find("gave up"),
            std::string::npos);
}

TEST(HttpTransport, NoticesWrongBytes) {
  Bytes file = sample_file();
  file[sample_index().chunks[1].offset + 3] ^= 4;
  HttpHost host(file, {});
  const Fetched fetched(host.url());
  ASSERT_FALSE(fetched.status.ok());
  EXPECT_EQ(fetched.status.error().code, ErrorCode::verification);
}

TEST(HttpTransport, SaysThatAFileIsNotFoundAtOnce) {
  HttpHost host(sample_file(), {});
  std::string url = host.url();
  url.insert(url.find("mesh.pmesh"), "no-");
  EXPECT_NE(Fetched(url).error().find("404"), std::string::npos);
  EXPECT_EQ(host.ranges().size(), 1u);
}

TEST(HttpTransport, SaysWhereAFileHasMoved) {
  HttpHost host({}, {.raw_answer = "HTTP/1.1 302 Found\r\nLocation: https://example.org/x\r\n"
                                   "Content-Length: 0\r\n\r\n"});
  EXPECT_NE(Fetched(host.url()).error().find("https://example.org/x"), std::string::npos);
}

TEST(HttpTransport, RefusesAnEncodedBody) {
  HttpHost host(sample_file(), {.extra_header = "Content-Encoding: gzip\r\n"});
  EXPECT_NE(Fetched(host.url()).error().find("gzip"), std::string::npos);
  EXPECT_EQ(host.ranges().size(), 1u);
}

TEST(HttpTransport, RefusesARangeThatWasNotAskedFor) {
  HttpHost host({}, {.raw_answer = "HTTP/1.1 206 Partial Content\r\nContent-Length: 3\r\n"
                                   "Content-Range: bytes 7-9/100\r\n\r\nabc"});
  EXPECT_NE(Fetched(host.url()).error().find("range"), std::string::npos);
}

TEST(HttpTransport, RefusesWhatIsNotHttp) {
  HttpHost host({}, {.raw_answer = "220 mail.example.org ESMTP\r\n\r\n"});
  EXPECT_NE(Fetched(host.url()).error().find("HTTP"), std::string::npos);
}

TEST(HttpTransport, RefusesAnEndlessHead) {
  HttpHost host({}, {.raw_answer = "HTTP/1.1 200 OK\r\nX: " + std::string(200'000, 'x')});
  EXPECT_FALSE(Fetched(host.url()).status.ok());
}

TEST(HttpTransport, TakesWhatAPartialFileHolds) {
  Bytes file = sample_file();
  file.resize(sample_index().chunks[1].end());
  HttpHost host(file, {});
  const Fetched fetched(host.url());
  EXPECT_EQ(fetched.error(), "");
  EXPECT_EQ(fetched.client.prefix().chunk_count(), 2u);
}

// As many bytes as make it worth asking twice for a range.
const Bytes& long_file() {
  static const Bytes file = test::make_pm_file(shapes::bumped(shapes::icosphere(6), 0.05));
  return file;
}

// Cuts one response late: what is fetched then begins far behind the file's start.
std::function<std::size_t()> late_cut(int response) {
  return [=, responses = 0]() mutable {
    return ++responses == response ? std::size_t(150'000) : SIZE_MAX;
  };
}

TEST(HttpTransport, AsksOnceMoreForARangeThatWasIgnored) {
  for (const char* target : {"/mesh", "/mesh.pmesh"}) {
    HttpHost host(long_file(), {.ignored_ranges = 1, .cut_after = random_cuts(1, 150'000)});
    const Fetched fetched(host.url(target));
    EXPECT_EQ(fetched.error(), "") << target;
    EXPECT_TRUE(std::ranges::equal(fetched.client.prefix().verified(), long_file())) << target;
    EXPECT_LT(fetched.client.bytes_fetched(), long_file().size() + 80'000) << target;
  }
}

TEST(HttpTransport, TakesChunksOfAServerBehindACacheThatIgnoresRanges) {
  HttpHost host(long_file(), {.ignores_ranges = true, .cut_after = late_cut(2)});
  const Fetched fetched(host.url("/mesh"));
  EXPECT_EQ(fetched.error(), "");
  EXPECT_TRUE(std::ranges::equal(fetched.client.prefix().verified(), long_file()));
  EXPECT_NE(host.targets().back().find("/c/"), std::string::npos);
}

TEST(HttpTransport, TakesTheWholeFileWhereThereAreNeitherRangesNorChunks) {
  for (const auto& [target, response] : {std::pair("/mesh", 2), std::pair("/mesh.pmesh", 1)}) {
    HttpHost host(long_file(),
                  {.ignores_ranges = true, .has_chunks = false, .cut_after = late_cut(response)});
    const Fetched fetched(host.url(target));
    EXPECT_EQ(fetched.error(), "") << target;
    EXPECT_TRUE(std::ranges::equal(fetched.client.prefix().verified(), long_file())) << target;
  }
}

TEST(HttpTransport, AsksForTheNameOnlyOnce) {
  HttpHost host(sample_file(), {.cut_after = random_cuts(2, 9000)});
  const Fetched fetched(host.url("/mesh"));
  EXPECT_EQ(fetched.error(), "");
  EXPECT_EQ(fetched.client.bytes_fetched(), sample_file().size());
  EXPECT_EQ(host.targets().back().find("/mesh/"), 0u);
  const auto whole = std::ranges::find_if(
      host.targets(), [](const std::string& target) { return target.starts_with("/mesh/"); });
  EXPECT_EQ(std::find(whole, host.targets().end(), "/mesh"), host.targets().end());
}

TEST(HttpTransport, SaysThatTheFileWasReplacedMeanwhile) {
  HttpHost host(sample_file(), {.cut_after = random_cuts(5, 20'000),
                                .replacement = test::other_file(),
                                .requests_until_replaced = 2});
  const Fetched fetched(host.url("/mesh"));
  EXPECT_NE(fetched.error().find("another"), std::string::npos) << fetched.error();
  EXPECT_EQ(fetched.client.remedy(), Remedy::start_over);
}

TEST(HttpTransport, TakesTheNewFileIfItWasReplacedBeforeItsFirstByte) {
  HttpHost host(sample_file(), {.replacement = test::other_file(), .requests_until_replaced = 1});
  const Fetched fetched(host.url("/mesh"));
  EXPECT_EQ(fetched.error(), "");
  EXPECT_TRUE(std::ranges::equal(fetched.client.prefix().verified(), test::other_file()));
}

TEST(HttpTransport, WaitsAsLongAsABusyHostAsks) {
  HttpHost host(sample_file(), {.failures = 1, .extra_header = "Retry-After: 1\r\n"});
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(Fetched(host.url()).error(), "");
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(990));
}

TEST(HttpTransport, ShowsItselfInEveryRequest) {
  for (const char* target : {"/mesh", "/mesh.pmesh"}) {
    HttpHost host(sample_file(), {});
    const Fetched fetched(host.url(target), "faces=5000",
                          {.token = "t", .http_fields = {{"X-Other", "1"}}});
    EXPECT_EQ(fetched.error(), "") << target;
    for (const std::string& request : host.requests()) {
      EXPECT_NE(request.find("Authorization: Bearer t\r\nX-Other: 1\r\n"), std::string::npos);
    }
  }
}

TEST(HttpTransport, CarriesAMeshsQueryToEveryRequest) {
  HttpHost host(sample_file(), {});
  const Fetched fetched(host.url("/mesh?expires=9&signature=ab"), "faces=5000");
  EXPECT_EQ(fetched.error(), "");
  const std::string hash = to_hex(sample_index().header.content_hash);
  EXPECT_EQ(host.targets(), (std::vector<std::string>{
                                "/mesh?expires=9&signature=ab",
                                "/mesh/" + hash + ".pmesh?faces=5000&expires=9&signature=ab"}));
}

TEST(HttpTransport, SaysThatItIsNotLetIn) {
  for (const char* status : {"401 Unauthorized", "403 Forbidden"}) {
    HttpHost host(
        {}, {.raw_answer = std::string("HTTP/1.1 ") + status + "\r\nContent-Length: 0\r\n\r\n"});
    const Fetched fetched(host.url());
    EXPECT_NE(fetched.error().find("token"), std::string::npos);
    EXPECT_TRUE(fetched.retries.empty());
  }
}

TEST(HttpTransport, SaysThatNobodyListens) {
  std::string url;
  {
    HttpHost host({}, {});
    url = host.url();
  }
  EXPECT_NE(Fetched(url).error().find("connecting"), std::string::npos);
}

TEST(HttpTransport, StopsSoonWhenCancelled) {
  HttpHost host(sample_file(), {.stalls = 1});
  CancelFlag cancel{false};
  TransportOptions options;
  options.cancel = &cancel;
  const auto transport = make_transport(*parse_mesh_url(host.url()), options);
  StreamOptions stream = Fetched::stream_options();
  stream.on_progress = [&](const StreamProgress&) { cancel = true; };
  StreamingClient client(*transport, stream);
  const Status status = client.fetch({});
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("interrupted"), std::string::npos);
}

}  // namespace
}  // namespace pmesh
