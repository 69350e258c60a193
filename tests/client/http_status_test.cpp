#include "client/http_status.h"

#include <gtest/gtest.h>

namespace pmesh {
namespace {

HttpResponse with_range(const char* text) {
  HttpResponse response;
  parse_content_range(text, response);
  return response;
}

TEST(ContentRange, TellsWhatCameAndOfHowMuch) {
  EXPECT_EQ(with_range("bytes 7-9/100").content_range, (ByteSpan{7, 10}));
  EXPECT_EQ(with_range("bytes 7-9/100").total_bytes, 100u);
  EXPECT_EQ(with_range("bytes 7-9/*").total_bytes, std::nullopt);
  EXPECT_EQ(with_range("bytes */100").content_range, std::nullopt);
  EXPECT_EQ(with_range("bytes */100").total_bytes, 100u);
}

TEST(ContentRange, IsNothingIfItIsNone) {
  for (const char* text :
       {"", "bytes", "bytes ", "bytes 7", "bytes 7-", "bytes 9-7/100", "bytes -1-2/3",
        "bytes 0-18446744073709551615/*", "bytes 99999999999999999999-1/2", "octets 7-9/100"}) {
    EXPECT_EQ(with_range(text).content_range, std::nullopt) << text;
  }
}

TEST(RetryAfter, IsANumberOfSeconds) {
  EXPECT_EQ(parse_retry_after("0"), std::chrono::seconds(0));
  EXPECT_EQ(parse_retry_after("120"), std::chrono::seconds(120));
  EXPECT_EQ(parse_retry_after("18446744073709551615"), std::chrono::hours(24));
  for (const char* text :
       {"", "-1", "1.5", "99999999999999999999", "Fri, 31 Dec 1999 23:59:59 GMT"}) {
    EXPECT_EQ(parse_retry_after(text), std::nullopt) << text;
  }
}

bool is_retryable(unsigned status) {
  HttpResponse response;
  response.status = status;
  return check_status(response, "http://h/x")->retryable;
}

TEST(HttpStatus, SaysWhetherToAskAgain) {
  for (const unsigned status : {408u, 429u, 500u, 502u, 503u, 504u}) {
    EXPECT_TRUE(is_retryable(status)) << status;
  }
  for (const unsigned status : {301u, 400u, 401u, 403u, 404u, 410u, 416u}) {
    EXPECT_FALSE(is_retryable(status)) << status;
  }
}

}  // namespace
}  // namespace pmesh
