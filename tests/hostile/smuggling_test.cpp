#include <set>

#include <gtest/gtest.h>

#include "tests/hostile/hostile_test.h"
#include "tests/hostile/requests.h"

namespace pmesh::testing {
namespace {

/// An ordinary request closes the connection, so that its one answer can be read to the end.
TEST_F(HostileTest, TheHiddenRequestIsSeenWhenItIsAnswered) {
  const std::string received =
      answers_to(get_request("/catalog") + get_request("/hidden", "Connection: close\r\n"));
  EXPECT_EQ(count_answers(received), 2u);
  EXPECT_NE(received.find("\"id\":\"hidden\",\"hash\"", received.find("HTTP/1.1 ", 1)),
            std::string::npos);
}

TEST_F(HostileTest, SmugglingIsRefusedOnce) {
  const std::vector<HostileRequest> variants = smuggling_requests();
  EXPECT_GE(variants.size(), 200u);
  for (const HostileRequest& variant : variants) {
    const std::string received = answers_to(variant.bytes);
    EXPECT_EQ(count_answers(received), 1u) << variant.name;
    EXPECT_TRUE(received.starts_with("HTTP/1.1 4") || received.starts_with("HTTP/1.1 5"))
        << variant.name << ": " << received.substr(0, 15);
    EXPECT_NE(received.find("\r\nConnection: close\r\n"), std::string::npos) << variant.name;
  }
}

TEST_F(HostileTest, VariantsDiffer) {
  std::set<std::string> seen;
  for (const HostileRequest& variant : smuggling_requests()) {
    EXPECT_TRUE(seen.insert(variant.bytes).second) << variant.name;
  }
}

TEST_F(HostileTest, OddRequestsHaveOneAnswer) {
  for (const HostileRequest& variant : odd_requests()) {
    const std::string received = answers_to(variant.bytes);
    EXPECT_EQ(count_answers(received), 1u) << variant.name << ": " << received;
  }
}

TEST_F(HostileTest, AFreshConnectionIsUnharmed) {
  for (const HostileRequest& variant : smuggling_requests()) {
    TestClient client(address());
    client.send(variant.bytes);
  }
  EXPECT_EQ(fetch(address(), "/health").status, 200);
}

}  // namespace
}  // namespace pmesh::testing
