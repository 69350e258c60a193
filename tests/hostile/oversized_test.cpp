#include <gtest/gtest.h>

#include "tests/hostile/hostile_test.h"

namespace pmesh::testing {
namespace {

/// Every one a refusal that closes the connection.
struct Oversized {
  std::string name;
  std::string bytes;
  int status;
};

std::string repeated(const std::string& text, std::size_t times) {
  std::string result;
  for (std::size_t i = 0; i < times; ++i) result += text;
  return result;
}

std::vector<Oversized> oversized_requests() {
  const std::string start = "GET /health HTTP/1.1\r\nHost: x\r\n";
  return {
      {"a target a byte too long", get_request("/" + std::string(8192, 'x')), 414},
      {"a target longer than the header may be", get_request("/" + std::string(20'000, 'x')), 414},
      {"a target that does not end", "GET /" + std::string(200'000, 'x'), 414},
      {"a query that does not end", "GET /mesh?" + repeated("faces=1&", 20'000), 414},
      {"a method that does not end", std::string(100'000, 'G'), 414},
      {"nothing but spaces", std::string(100'000, ' '), 414},
      {"a long field", get_request("/health", "X: " + std::string(16'384, 'x') + "\r\n"), 431},
      {"a long name", get_request("/health", std::string(16'384, 'x') + ": y\r\n"), 431},
      {"a field that does not end", start + "X: " + std::string(200'000, 'x'), 431},
      {"a name that does not end", start + std::string(200'000, 'X'), 431},
      {"a field too many", get_request("/health", repeated("X: y\r\n", 100)), 431},
      {"short fields without end", start + repeated("X: y\r\n", 50'000), 431},
      {"empty fields without end", start + repeated("X:\r\n", 50'000), 431},
      {"a Range of a thousand ranges",
       get_request("/health", "Range: bytes=" + repeated("0-0,", 5'000) + "0-0\r\n"), 431},
      {"a Cookie of 16 KiB", get_request("/health", "Cookie: " + std::string(16'384, 'c') + "\r\n"),
       431},
      {"a version that does not end", "GET /health HTTP/" + repeated("1.", 50'000), 414},
      {"a hundred thousand lines", repeated("\r\n", 100'000), 400},
      {"zeros", std::string(100'000, '\0'), 414},
  };
}

TEST_F(HostileTest, OversizedRequestsAreRefused) {
  for (const Oversized& request : oversized_requests()) {
    const std::string received = answers_to(request.bytes);
    EXPECT_TRUE(received.starts_with("HTTP/1.1 " + std::to_string(request.status)))
        << request.name << ": " << received.substr(0, 15);
    EXPECT_EQ(count_answers(received), 1u) << request.name;
  }
}

TEST_F(HostileTest, LargestRequestsAreTaken) {
  EXPECT_EQ(fetch(address(), "/" + std::string(8191, 'x')).status, 404);
  EXPECT_EQ(fetch(address(), "/health", repeated("X: y\r\n", 99)).status, 200);
  EXPECT_EQ(fetch(address(), "/health", "X: " + std::string(16'000, 'x') + "\r\n").status, 200);
  const std::string method(8'000, 'G');
  EXPECT_TRUE(answers_to(method + " /health HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n")
                  .starts_with("HTTP/1.1 4"));
}

}  // namespace
}  // namespace pmesh::testing
