#include "server/http/request_parser.h"

#include <gtest/gtest.h>

namespace pmesh {
namespace {

using Step = RequestParser::Step;

class RequestParserTest : public ::testing::Test {
 protected:
  /// The status that `bytes`, fed at once, are refused with; 0 if they are a request.
  int refusal_of(const std::string& bytes) {
    RequestParser parser(limits_);
    parser.feed(bytes);
    const Step step = parser.next();
    EXPECT_NE(step, Step::more) << bytes;
    return step == Step::refusal ? parser.refusal() : 0;
  }
  int refusal_of_field(const std::string& field) {
    return refusal_of("GET / HTTP/1.1\r\nHost: x\r\n" + field + "\r\n\r\n");
  }

  SessionLimits limits_;
};

TEST_F(RequestParserTest, GivesRequestsOneByOneInAnyCuts) {
  const std::string bytes =
      "GET /a HTTP/1.1\r\nHost: x\r\nRange: bytes=0-1\r\n\r\n"
      "\r\nHEAD /b HTTP/1.0\r\nIf-None-Match: \"t\"\r\n\r\n";
  for (std::size_t cut = 1; cut <= bytes.size(); ++cut) {
    RequestParser parser(limits_);
    std::vector<std::string> seen;
    for (std::size_t begin = 0; begin < bytes.size(); begin += cut) {
      parser.feed(std::string_view(bytes).substr(begin, cut));
      while (parser.next() == Step::request) {
        const HttpRequest request = parser.request();
        seen.push_back(std::string(request.method).append(request.target).append(request.range));
        seen.back().append(request.if_none_match);
      }
    }
    EXPECT_EQ(seen, (std::vector<std::string>{"GET/abytes=0-1", "HEAD/b\"t\""})) << cut;
    EXPECT_TRUE(parser.empty());
  }
}

TEST_F(RequestParserTest, KnowsWhetherTheConnectionIsKept) {
  const auto keeps = [&](const std::string& bytes) {
    RequestParser parser(limits_);
    parser.feed(bytes);
    EXPECT_EQ(parser.next(), Step::request);
    return parser.keep_alive();
  };
  EXPECT_TRUE(keeps("GET / HTTP/1.1\r\nHost: x\r\n\r\n"));
  EXPECT_FALSE(keeps("GET / HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n"));
  EXPECT_FALSE(keeps("GET / HTTP/1.0\r\n\r\n"));
  EXPECT_TRUE(keeps("GET / HTTP/1.0\r\nConnection: keep-alive\r\n\r\n"));
}

TEST_F(RequestParserTest, JoinsForwardedFor) {
  RequestParser parser(limits_);
  parser.feed(
      "GET / HTTP/1.1\r\nHost: x\r\nX-Forwarded-For: 1.1.1.1\r\n"
      "x-forwarded-for: 2.2.2.2, 3.3.3.3\r\n\r\n");
  EXPECT_EQ(parser.next(), Step::request);
  EXPECT_EQ(parser.forwarded_for(), "1.1.1.1,2.2.2.2, 3.3.3.3");
}

TEST_F(RequestParserTest, JoinsIfNoneMatch) {
  RequestParser parser(limits_);
  parser.feed(
      "GET / HTTP/1.1\r\nHost: x\r\nIf-None-Match: \"a\", W/\"b\"\r\n"
      "If-Range: \"d\"\r\nIF-NONE-MATCH: \"c\"\r\n\r\n");
  EXPECT_EQ(parser.next(), Step::request);
  EXPECT_EQ(parser.request().if_none_match, "\"a\", W/\"b\",\"c\"");
}

TEST_F(RequestParserTest, TakesARepeatedRangeForNone) {
  const auto range_of = [&](const std::string& fields) {
    RequestParser parser(limits_);
    parser.feed("GET / HTTP/1.1\r\nHost: x\r\n" + fields + "\r\n");
    EXPECT_EQ(parser.next(), Step::request) << fields;
    return std::string(parser.request().range);
  };
  const std::string range = "Range: bytes=0-1\r\n", if_range = "If-Range: \"a\"\r\n";
  EXPECT_EQ(range_of(range), "bytes=0-1");
  EXPECT_EQ(range_of(range + if_range), "bytes=0-1");
  EXPECT_EQ(range_of(range + range), "");
  EXPECT_EQ(range_of(range + "range: bytes=5-6\r\n"), "");
  EXPECT_EQ(range_of(if_range + range + if_range), "");
}

TEST_F(RequestParserTest, KnowsWhatCanBeAHost) {
  const auto refusal_of_host = [&](const std::string& host) {
    return refusal_of("GET / HTTP/1.1\r\nHost:" + host + "\r\n\r\n");
  };
  for (const char* host : {"", " ", " example.org", " example.org:8080", " example.org:", " :80",
                           " 127.0.0.1:1", " [::1]", " [2001:db8::7]:443", " [::ffff:192.0.2.1]",
                           " a_b.c-d~e", " sub!$&'()*+,;=", " caf%C3%A9"}) {
    EXPECT_EQ(refusal_of_host(host), 0) << host;
  }
  for (const char* host : {" a b",     " a/b",
                           " a?b",     " a#b",
                           " a@b",     " user:pw@host",
                           " a\\b",    " a:b",
                           " a:80:80", " ::1",
                           " a:8x",    " a:-1",
                           " \"a\"",   " <a>",
                           " a|b",     " a^b",
                           " {a}",     " a\xC3\xA9",
                           " [::1",    " []",
                           " []:80",   " [::1]80",
                           " [::1]:x", " [::1]]",
                           " [[::1]]", " [fe80::1%25eth0]",
                           " a[::1]",  " ::1]",
                           " a\tb"}) {
    EXPECT_EQ(refusal_of_host(host), 400) << host;
  }
  EXPECT_EQ(refusal_of("GET / HTTP/1.0\r\nHost: a/b\r\n\r\n"), 400);
}

TEST_F(RequestParserTest, KnowsAWebSocketsHandshake) {
  const auto upgrades = [&](const std::string& version, const std::string& key) {
    RequestParser parser(limits_);
    parser.feed(
        "GET / HTTP/1.1\r\nHost: x\r\nConnection: keep-alive, Upgrade\r\nUpgrade: websocket\r\n" +
        version + key + "\r\n");
    EXPECT_EQ(parser.next(), Step::request);
    return parser.request().upgrade;
  };
  const std::string version = "Sec-WebSocket-Version: 13\r\n";
  const std::string key = "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
  EXPECT_TRUE(upgrades(version, key));
  EXPECT_FALSE(upgrades("", key));
  EXPECT_FALSE(upgrades("Sec-WebSocket-Version: 8\r\n", key));
  EXPECT_FALSE(upgrades(version, ""));
  EXPECT_FALSE(upgrades(version, "Sec-WebSocket-Key: short\r\n"));
}

TEST_F(RequestParserTest, SkipsSomeEmptyLines) {
  EXPECT_EQ(refusal_of("\r\n\r\n\r\nGET / HTTP/1.1\r\nHost: x\r\n\r\n"), 0);
  std::string many;
  for (int i = 0; i < 100; ++i) many += "\r\n";
  EXPECT_EQ(refusal_of(many), 400);
}

TEST_F(RequestParserTest, RefusesRequestLinesThatCanBeReadInTwoWays) {
  for (const char* line :
       {"GET  / HTTP/1.1", "GET / HTTP/1.1 ", " GET / HTTP/1.1", "GET /", "GET / HTTP/1.2",
        "GET / HTTP/2.0", "GET / http/1.1", "GET /a b HTTP/1.1", "GET\t/ HTTP/1.1",
        "GET /\x7F HTTP/1.1", "GET /\xC3\xA4 HTTP/1.1", "G(T / HTTP/1.1", "GET /\r HTTP/1.1",
        "GET /\nX HTTP/1.1"}) {
    EXPECT_EQ(refusal_of(std::string(line) + "\r\nHost: x\r\n\r\n"), 400) << line;
  }
}

TEST_F(RequestParserTest, RefusesFieldsThatCanBeReadInTwoWays) {
  for (const std::string field :
       {"X : y", " X: y", "\tX: y", "X: y\r\n folded", "X: y\r\n\tfolded", "X", ": y", "X\t: y",
        "X: a\rb", "X: a\nY: b", "X\x01: y", "X: y\x01z", "Host: y", "X(: y"}) {
    EXPECT_EQ(refusal_of_field(field), 400) << field;
  }
  EXPECT_EQ(refusal_of_field(std::string("X: a\0b", 6)), 400);
  EXPECT_EQ(refusal_of("GET / HTTP/1.1\r\n\r\n"), 400);
}

TEST_F(RequestParserTest, RefusesBodiesHoweverTheyAreAnnounced) {
  for (const char* field :
       {"Content-Length: 5", "Content-Length: 00", "Content-Length: 0\r\nContent-Length: 0",
        "Transfer-Encoding: chunked", "Transfer-Encoding: identity",
        "Content-Length: 0\r\nTransfer-Encoding: chunked", "Transfer-Encoding:\tchunked"}) {
    const int status = refusal_of_field(field);
    EXPECT_TRUE(status == 413 || status == 400) << field << ": " << status;
  }
  EXPECT_EQ(refusal_of_field("Content-Length: 0"), 0);
  for (const char* value : {"+0", "-0", "0x0", "0, 0", "", "99999999999999999999"}) {
    EXPECT_NE(refusal_of_field(std::string("Content-Length: ").append(value)), 0) << value;
  }
}

TEST_F(RequestParserTest, HoldsTheLimits) {
  limits_ = {.header_bytes = 2000, .header_fields = 5, .target_bytes = 100};
  EXPECT_EQ(refusal_of("GET /" + std::string(99, 'a') + " HTTP/1.1\r\nHost: x\r\n\r\n"), 0);
  EXPECT_EQ(refusal_of("GET /" + std::string(100, 'a') + " HTTP/1.1\r\nHost: x\r\n\r\n"), 414);
  EXPECT_EQ(refusal_of("GET /" + std::string(3000, 'a')), 414);
  EXPECT_EQ(refusal_of_field("X: " + std::string(2000, 'a')), 431);
  EXPECT_EQ(refusal_of("GET / HTTP/1.1\r\nX: " + std::string(3000, 'a')), 431);
  EXPECT_EQ(refusal_of_field("A: 1\r\nB: 1\r\nC: 1\r\nD: 1"), 0);
  EXPECT_EQ(refusal_of_field("A: 1\r\nB: 1\r\nC: 1\r\nD: 1\r\nE: 1"), 431);
}

}  // namespace
}  // namespace pmesh
