#include <random>

#include <gtest/gtest.h>

#include "tests/hostile/hostile_test.h"

namespace pmesh::testing {
namespace {

class HostileRangesTest : public HostileTest {
 protected:
  HttpResponse get(const std::string& range, const std::string& more = "") const {
    return fetch(address(), target_, "Range: " + range + "\r\n" + more);
  }

  const SampleFile mesh_ = make_sample({20'000, 30'000});
  const std::uint64_t size_ = mesh_.bytes.size();
  const std::string target_ = "/mesh/" + mesh_.hash() + ".pmesh";
};

/// The bytes of the file from `begin` to before `end`, as 206.
struct Part {
  std::string range;
  std::uint64_t begin;
  std::uint64_t end;
};

TEST_F(HostileRangesTest, PartsHaveTheirBytes) {
  const std::string last = std::to_string(size_ - 1);
  const std::string most = "18446744073709551615";
  const std::string beyond = "18446744073709551616";
  for (const Part& part : std::vector<Part>{
           {"bytes=0-0", 0, 1},
           {"bytes=0-", 0, size_},
           {"bytes=0-" + last, 0, size_},
           {"bytes=" + last + "-", size_ - 1, size_},
           {"bytes=" + last + "-" + last, size_ - 1, size_},
           {"bytes=-1", size_ - 1, size_},
           {"bytes=-" + std::to_string(size_), 0, size_},
           {"bytes=-" + std::to_string(size_ + 1), 0, size_},
           {"bytes=-" + most, 0, size_},
           {"bytes=-" + beyond, 0, size_},
           {"bytes=5-" + most, 5, size_},
           {"bytes=5-" + beyond, 5, size_},
           {"bytes=5-9223372036854775807", 5, size_},
           {"bytes=5-9223372036854775808", 5, size_},
           {"bytes=0000000000000000000000007-9", 7, 10},
           {"BYTES=7-9", 7, 10},
           {" bytes=7-9 ", 7, 10},
       }) {
    const HttpResponse response = get(part.range);
    EXPECT_EQ(response.status, 206) << part.range;
    EXPECT_EQ(response.body, mesh_.text(part.begin, part.end)) << part.range;
    EXPECT_EQ(response.field("Content-Range"), "bytes " + std::to_string(part.begin) + "-" +
                                                   std::to_string(part.end - 1) + "/" +
                                                   std::to_string(size_));
  }
}

TEST_F(HostileRangesTest, RangesBeyondTheEndAreRefused) {
  for (const std::string& range :
       {"bytes=" + std::to_string(size_) + "-",
        "bytes=" + std::to_string(size_) + "-" + std::to_string(size_ + 1),
        std::string("bytes=18446744073709551615-"), std::string("bytes=18446744073709551616-"),
        std::string("bytes=9223372036854775808-9223372036854775809"), std::string("bytes=-0"),
        std::string("bytes=99999999999999999999999999-")}) {
    const HttpResponse response = get(range);
    EXPECT_EQ(response.status, 416) << range;
    EXPECT_EQ(response.field("Content-Range"), "bytes */" + std::to_string(size_)) << range;
  }
}

TEST_F(HostileRangesTest, WhatIsNoRangeIsIgnored) {
  for (const char* range :
       {"bytes=", "bytes", "bytes=-", "bytes=9-7", "bytes=a-b", "bytes=0x1-2", "bytes=+1-2",
        "bytes=1--2", "bytes=1-2-3", "bytes 1-2", "bytes=1 -2", "bytes=1-2;", "items=1-2", "=1-2",
        "bytes=1-2,4-5", "bytes=1-2,", "bytes=1.0-2", "bytes=\xc2\xb9-2", ""}) {
    const HttpResponse response = get(range);
    EXPECT_EQ(response.status, 200) << range;
    EXPECT_EQ(response.body.size(), size_) << range;
  }
}

TEST_F(HostileRangesTest, TooManyRangesAreRefused) {
  std::string many = "bytes=0-0";
  for (int i = 1; i < 8; ++i) many += ",0-0";
  EXPECT_EQ(get(many).status, 200);
  EXPECT_EQ(get(many + ",0-0").status, 416);
}

TEST_F(HostileRangesTest, IfRangeNeedsTheStrongTag) {
  const std::string tag = "\"" + mesh_.hash() + "\"";
  EXPECT_EQ(get("bytes=7-9", "If-Range: " + tag + "\r\n").status, 206);
  for (const std::string& other :
       {"W/" + tag, std::string("\"x\""), mesh_.hash(), std::string("*"), tag + ", " + tag,
        std::string("Mon, 01 Jan 2035 00:00:00 GMT")}) {
    EXPECT_EQ(get("bytes=7-9", "If-Range: " + other + "\r\n").status, 200) << other;
  }
}

/// Of two, one who stands between might take the first, another the last.
TEST_F(HostileRangesTest, TwoFieldsForARangeAskForNone) {
  const std::string tag = "If-Range: \"" + mesh_.hash() + "\"\r\n";
  EXPECT_EQ(get("bytes=7-9", tag).status, 206);
  for (const std::string& fields : {std::string("Range: bytes=1-2\r\n"), tag + tag}) {
    const HttpResponse response = get("bytes=7-9", fields);
    EXPECT_EQ(response.status, 200) << fields;
    EXPECT_EQ(response.body, mesh_.text());
  }
}

TEST_F(HostileRangesTest, HeadIgnoresRanges) {
  TestClient client(address());
  client.send("HEAD " + target_ + " HTTP/1.1\r\nHost: x\r\nRange: bytes=7-9\r\n\r\n");
  const HttpResponse response = read_response(client, false);
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(response.field("Content-Length"), std::to_string(size_));
}

/// `count` ranges asked for in one go, and the bytes that they must give.
struct Batch {
  Batch(const SampleFile& mesh, const std::string& target, std::mt19937& random, int count) {
    const std::uint64_t size = mesh.bytes.size();
    for (int i = 0; i < count; ++i) {
      const std::uint64_t begin = random() % size;
      const std::uint64_t end = std::min(size, begin + 1 + random() % 2000);
      requests += get_request(
          target, "Range: bytes=" + std::to_string(begin) + "-" + std::to_string(end - 1) + "\r\n");
      bodies.push_back(mesh.text(begin, end));
    }
  }

  std::string requests;
  std::vector<std::string> bodies;
};

TEST_F(HostileRangesTest, AHundredThousandRandomRangesHaveTheFilesBytes) {
  constexpr int kBatch = 50;  // all its requests fit into what the kernel buffers
  std::mt19937 random(1);
  TestClient client(address());
  for (int done = 0; done < 100'000; done += kBatch) {
    const Batch batch(mesh_, target_, random, kBatch);
    client.send(batch.requests);
    for (const std::string& body : batch.bodies) ASSERT_EQ(read_response(client).body, body);
  }
}

}  // namespace
}  // namespace pmesh::testing
