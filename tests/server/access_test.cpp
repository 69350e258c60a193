#include <gtest/gtest.h>

#include "server/access/access_policy.h"
#include "server/access/credentials.h"
#include "tests/fixtures/temporary_directory.h"

namespace pmesh {
namespace {

constexpr std::string_view kToken = "0123456789abcdef";
const std::string kKey(32, 'k');
constexpr std::uint64_t kNow = 1'800'000'000;

AccessPolicy guarded() {
  return AccessPolicy({.tokens = {"another-token-of-it", std::string(kToken)}, .url_key = kKey});
}

/// How a signed query for `signed_id` is judged when `id` is asked for at `now`.
Access judged(const std::string& query, std::string_view id, std::uint64_t now = kNow) {
  const SplitQuery split = *split_query(query);
  return guarded().judge({.signature = split.signature, .mesh_id = id, .now = now});
}

TEST(AccessPolicy, GrantsAllWithoutSecrets) {
  const AccessPolicy open{AccessOptions{}};
  EXPECT_TRUE(open.is_public());
  EXPECT_EQ(open.judge({}), Access::granted);
}

TEST(AccessPolicy, GrantsAnyOfItsTokens) {
  EXPECT_FALSE(guarded().is_public());
  EXPECT_EQ(guarded().judge({.authorization = "Bearer 0123456789abcdef"}), Access::granted);
  EXPECT_EQ(guarded().judge({.authorization = "bearer   another-token-of-it"}), Access::granted);
}

TEST(AccessPolicy, AsksForATokenWhereNoneOrAWrongOneIs) {
  for (const std::string_view wrong :
       {"", "Bearer", "Bearer ", "Bearer 0123456789abcde", "Bearer 0123456789abcdef0",
        "Basic 0123456789abcdef", "0123456789abcdef"}) {
    EXPECT_EQ(guarded().judge({.authorization = wrong}), Access::unauthenticated) << wrong;
  }
}

TEST(AccessPolicy, GrantsASignedMeshUntilItExpires) {
  const std::string query = sign_query(kKey, "scans~bunny", kNow);
  EXPECT_EQ(judged(query, "scans~bunny"), Access::granted);
  EXPECT_EQ(judged(query, "scans~bunny", kNow + 1), Access::forbidden);
}

TEST(AccessPolicy, ForbidsWhatASignatureDoesNotCover) {
  const std::string query = sign_query(kKey, "bunny", kNow);
  EXPECT_EQ(judged(query, "dragon"), Access::forbidden);
  EXPECT_EQ(judged(query, ""), Access::forbidden) << "the catalogue";
  EXPECT_EQ(judged(sign_query(std::string(32, 'x'), "bunny", kNow), "bunny"), Access::forbidden);
}

TEST(AccessPolicy, ForbidsEveryAlteredSignature) {
  const std::string query = sign_query(kKey, "bunny", kNow);
  for (std::size_t i = query.find("signature=") + 10; i < query.size(); ++i) {
    std::string altered = query;
    altered[i] = altered[i] == '0' ? '1' : '0';
    EXPECT_EQ(judged(altered, "bunny"), Access::forbidden) << i;
  }
  EXPECT_EQ(judged("expires=1900000000", "bunny"), Access::forbidden);
  EXPECT_EQ(judged("signature=", "bunny"), Access::forbidden);
  EXPECT_EQ(judged("expires=x&signature=y", "bunny"), Access::forbidden);
}

TEST(AccessPolicy, LooksAtNoSignatureWithoutAKey) {
  const AccessPolicy tokens_only({.tokens = {std::string(kToken)}, .url_key = ""});
  EXPECT_EQ(tokens_only.judge({.signature = UrlSignature{"1900000000", ""}, .mesh_id = "bunny"}),
            Access::unauthenticated);
}

// HMAC-SHA256 by another implementation: printf 'pmesh signed url\nbunny\n1800000000' |
// openssl dgst -sha256 -hmac kkkkkkkkkkkkkkkkkkkkkkkkkkkkkkkk
TEST(SignedQuery, IsAnHmacOfPurposeMeshAndExpiry) {
  EXPECT_EQ(sign_query(kKey, "bunny", kNow),
            "expires=1800000000&signature="
            "20c74fa16b42cf7545742ddfe68d5b5d8171b1964a0533f1432d785d64f420f9");
}

TEST(SignedQuery, IsTakenOutWhereverItStands) {
  for (const char* query : {"faces=100&expires=7&signature=ab", "expires=7&faces=100&signature=ab",
                            "signature=ab&expires=7&faces=100"}) {
    const auto split = split_query(query);
    EXPECT_EQ(split->rest, "faces=100");
    EXPECT_EQ(split->signature->expires, "7");
    EXPECT_EQ(split->signature->signature, "ab");
  }
}

TEST(SignedQuery, LeavesOtherQueriesAsTheyAre) {
  for (const char* query : {"", "faces=100", "a&b", "&", "a&", "&a", "expires", "xexpires=1"}) {
    const auto split = split_query(query);
    EXPECT_EQ(split->rest, query);
    EXPECT_FALSE(split->signature);
  }
}

TEST(SignedQuery, HasEachMemberOnce) {
  EXPECT_EQ(split_query("expires=1&expires=1").error().code, ErrorCode::usage);
  EXPECT_FALSE(split_query("signature=a&faces=1&signature=a"));
}

TEST(SignedQuery, IsHiddenInLogsAndNothingElseIs) {
  EXPECT_EQ(hide_signatures("/bunny?faces=1&expires=7&signature=0ab"),
            "/bunny?faces=1&expires=7&signature=...");
  EXPECT_EQ(hide_signatures("/bunny?signature=0ab&faces=1&signature=1&signature="),
            "/bunny?signature=...&faces=1&signature=...&signature=...");
  for (const char* target :
       {"", "*", "/", "?", "/bunny", "/bunny?", "/signature=1/x", "/bunny?faces=1&&expires=7&",
        "/bunny?asignature=1&signatures=2&signature"}) {
    EXPECT_EQ(hide_signatures(target), target);
  }
}

TEST(Credentials, AreTokensOneALine) {
  EXPECT_EQ(*parse_tokens("# who\r\n\n  0123456789abcdef \r\nABCDEFGHIJKLMNOP-._~+/="),
            (std::vector<std::string>{"0123456789abcdef", "ABCDEFGHIJKLMNOP-._~+/="}));
}

TEST(Credentials, RefuseWhatIsNoTokenWithoutShowingIt) {
  const auto refused = parse_tokens("0123456789abcdef\nsecret with blanks in\n");
  EXPECT_TRUE(refused.error().message.starts_with("line 2: "));
  EXPECT_EQ(refused.error().message.find("secret"), std::string::npos);
  EXPECT_FALSE(parse_tokens("0123456789abcde")) << "too short";
}

TEST(Credentials, RefuseAFileWithoutTokens) {
  EXPECT_FALSE(parse_tokens(""));
  EXPECT_FALSE(parse_tokens("# 0123456789abcdef\n"));
}

TEST(Credentials, RefuseAShortKey) {
  const TemporaryDirectory directory;
  put_contents(directory / "key", std::string(31, 'k'));
  EXPECT_FALSE(read_url_key_file(directory / "key"));
  put_contents(directory / "key", std::string(31, 'k') + "\n");
  EXPECT_EQ(read_url_key_file(directory / "key")->size(), 32u) << "all bytes count";
}

}  // namespace
}  // namespace pmesh
