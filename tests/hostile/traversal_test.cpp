#include <gtest/gtest.h>

#include "tests/hostile/hostile_test.h"
#include "tests/hostile/requests.h"

namespace pmesh::testing {
namespace {

/// The answer to `target`, which is found nowhere.
void expect_nothing(const std::string& address, const std::string& target) {
  const HttpResponse response = fetch(address, target);
  EXPECT_TRUE(response.status == 400 || response.status == 404)
      << target << ": " << response.status;
  EXPECT_EQ((response.head + response.body).find(kSecret), std::string::npos) << target;
}

TEST_F(HostileTest, NoTargetLeadsOut) {
  const std::vector<std::string> targets = traversal_targets();
  EXPECT_GE(targets.size(), 200u);
  for (const std::string& target : targets) expect_nothing(address(), target);
}

TEST_F(HostileTest, NoTargetLeadsOutWithTheRightHash) {
  const std::string hash = make_sample({100, 100}, 4).hash();
  for (const std::string& target : traversal_targets()) {
    expect_nothing(address(), target + "/" + hash + ".pmesh");
  }
}

TEST_F(HostileTest, LinksLeadNowhere) {
  for (const char* id : {"link", "folder~relative", "outside~secret", "outside", "outside~mesh"}) {
    expect_nothing(address(), std::string("/") + id);
  }
  EXPECT_EQ(fetch(address(), "/catalog").body.find("secret"), std::string::npos);
  EXPECT_EQ(fetch(address(), "/folder~inner").status, 200);
}

}  // namespace
}  // namespace pmesh::testing
