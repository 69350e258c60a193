#include "client/http_field.h"

#include <string>

#include <gtest/gtest.h>

namespace pmesh {
namespace {

TEST(HttpField, HasANameAndAValue) {
  EXPECT_EQ(*parse_http_field("X-Key: a b"), (HttpField{"X-Key", "a b"}));
  EXPECT_EQ(*parse_http_field("X-Key:  \t v:w "), (HttpField{"X-Key", "v:w"}));
  EXPECT_EQ(*parse_http_field("Cookie:"), (HttpField{"Cookie", ""}));
  EXPECT_EQ(*parse_http_field("Hosted: 1"), (HttpField{"Hosted", "1"}));
}

TEST(HttpField, RefusesWhatIsNone) {
  for (const char* text : {"", ":", ": v", "Key", "Ke y: v", "Key : v", "Key: a\r\nHost: b",
                           "Key: a\nb", "Key: \x7F", "K\xE9y: v"}) {
    const Result<HttpField> field = parse_http_field(text);
    ASSERT_FALSE(field.ok()) << text;
    EXPECT_EQ(field.error().code, ErrorCode::usage) << text;
  }
}

TEST(HttpField, RefusesFieldsThatTheClientSets) {
  for (const char* text : {"Host: x", "RANGE: bytes=0-1", "content-length: 1", "Connection: close",
                           "Transfer-Encoding: chunked", "Sec-WebSocket-Key: x", "If-Range: x",
                           "Upgrade: x", "Accept-Encoding: gzip"}) {
    EXPECT_FALSE(parse_http_field(text).ok()) << text;
  }
}

TEST(Token, IsWithoutTheSpaceAroundIt) {
  EXPECT_EQ(*parse_token("abc-._~+/=9"), "abc-._~+/=9");
  EXPECT_EQ(*parse_token(" abc\r\n"), "abc");
}

TEST(Token, IsNotWhatNoTokenCanBe) {
  for (const char* token : {"", "\n", "a b", "a\nb", "\"a\"", "\xC3\xA9"}) {
    EXPECT_FALSE(parse_token(token).ok()) << token;
  }
}

TEST(Token, LeadsTheFieldsOfARequest) {
  EXPECT_EQ(with_token("t", {{"X", "1"}}),
            (std::vector<HttpField>{{"Authorization", "Bearer t"}, {"X", "1"}}));
  EXPECT_EQ(with_token("", {{"X", "1"}}), (std::vector<HttpField>{{"X", "1"}}));
}

}  // namespace
}  // namespace pmesh
