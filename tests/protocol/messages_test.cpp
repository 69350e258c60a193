#include "protocol/messages.h"

#include <gtest/gtest.h>

namespace pmesh {
namespace {

/// The payload of a whole frame.
ByteView payload(const Bytes& frame) { return ByteView(frame).subspan(kFrameHeaderBytes); }

/// Every shorter payload, and one with a byte too many, must fail in `parse`.
template <class Parse>
void expect_exact_size(const Bytes& frame, Parse parse) {
  Bytes longer(payload(frame).begin(), payload(frame).end());
  longer.push_back(0);
  EXPECT_FALSE(parse(ByteView(longer)).ok());
  for (std::size_t size = 0; size < payload(frame).size(); ++size) {
    const Bytes shorter(payload(frame).begin(), payload(frame).begin() + size);
    EXPECT_FALSE(parse(ByteView(shorter)).ok()) << size;
  }
}

TEST(Messages, HelloComesBack) {
  const Hello hello{.max_frame = 4096};
  EXPECT_EQ(parse_hello(payload(encode_hello(hello))).value(), hello);
  expect_exact_size(encode_hello(hello), parse_hello);
}

TEST(Messages, HelloOfAnotherVersionMayGoOnAsItLikes) {
  for (const std::string_view rest :
       {std::string_view(), std::string_view("\0\x10\0\0 and more")}) {
    const std::string later = std::string("PMTP\x01\0", 6).append(rest);
    EXPECT_EQ(parse_hello(as_bytes(later)).value().version, 1);
  }
  EXPECT_FALSE(parse_hello(as_bytes("PMTP\x01")).ok());
}

TEST(Messages, HelloNeedsItsMagicAndAUsableLimit) {
  EXPECT_FALSE(parse_hello(as_bytes(std::string_view("PMTX\0\0\0\0\x10\0", 10))).ok());
  EXPECT_FALSE(parse_hello(payload(encode_hello({.max_frame = kMinFrameLimit - 1}))).ok());
  EXPECT_TRUE(parse_hello(payload(encode_hello({.max_frame = 0xFFFFFFFF}))).ok());
}

TEST(Messages, OpenComesBackWithAndWithoutAHash) {
  const Open any{.id = "scans~bunny", .hash = {}}, one{.id = "bunny", .hash = ContentHash{1, 2}};
  EXPECT_EQ(parse_open(payload(encode_open(1, any))).value(), any);
  EXPECT_EQ(parse_open(payload(encode_open(1, one))).value(), one);
}

TEST(Messages, OpenRejectsPartOfAHashOrOfAnId) {
  const Bytes frame = encode_open(1, {.id = "bunny", .hash = ContentHash{}});
  EXPECT_FALSE(parse_open(payload(frame).first(payload(frame).size() - 1)).ok());
  EXPECT_FALSE(parse_open(as_bytes(std::string_view("\xFF\xFF"
                                                    "a",
                                                    3)))
                   .ok());
}

TEST(Messages, OpenLeavesTheIdToItsReceiver) {
  EXPECT_EQ(parse_open(as_bytes(std::string_view("\x02\0..", 4))).value().id, "..");
}

TEST(Messages, OpenedComesBack) {
  const Opened opened{{9, 8, 7}, 1000, 500, 996, 10, 16, 12};
  EXPECT_EQ(parse_opened(payload(encode_opened(1, opened))).value(), opened);
  expect_exact_size(encode_opened(1, opened), parse_opened);
}

TEST(Messages, WantComesBack) {
  const Want want{.from_offset = 77, .wish = {.kind = WishKind::faces, .count = 5}};
  EXPECT_EQ(parse_want(payload(encode_want(1, want))).value(), want);
  EXPECT_EQ(parse_want(payload(encode_want(1, {}))).value(), Want{});
  const Want near{.wish = {.kind = WishKind::error, .error = 0.1, .error_is_percent = true}};
  EXPECT_EQ(parse_want(payload(encode_want(1, near))).value(), near);
}

TEST(Messages, WantTellsABadWishFromABadMessage) {
  EXPECT_EQ(parse_want(as_bytes(std::string_view("\0\0\0\0\0\0\0\0x=1", 11))).error().code,
            ErrorCode::usage);
  EXPECT_EQ(parse_want(as_bytes("short")).error().code, ErrorCode::bad_input);
}

TEST(Messages, DataComesBack) {
  const Bytes frame = encode_data(1, {1ull << 40, as_bytes("xyz")});
  const Data data = parse_data(payload(frame)).value();
  EXPECT_EQ(data.offset, 1ull << 40);
  EXPECT_EQ(Bytes(data.bytes.begin(), data.bytes.end()), (Bytes{'x', 'y', 'z'}));
  EXPECT_FALSE(parse_data(as_bytes("1234567")).ok());
}

TEST(Messages, DoneComesBack) {
  const Done done{.end = 12, .faces = 34, .vertices = 56, .reached = false};
  EXPECT_EQ(parse_done(payload(encode_done(1, done))).value(), done);
  expect_exact_size(encode_done(1, done), parse_done);
}

TEST(Messages, DoneNeedsATruthValue) {
  Bytes frame = encode_done(1, {});
  frame.back() = 2;
  EXPECT_FALSE(parse_done(payload(frame)).ok());
}

TEST(Messages, FailureComesBack) {
  const Failure failure{FailureCode::bad_wish, "no such chunk"};
  EXPECT_EQ(parse_failure(payload(encode_failure(1, failure))).value(), failure);
  EXPECT_FALSE(parse_failure(as_bytes("x")).ok());
}

TEST(Messages, FailureTextIsBounded) {
  const Failure failure{FailureCode::busy, std::string(5000, 'x')};
  EXPECT_EQ(parse_failure(payload(encode_failure(0, failure))).value().text.size(), 512u);
  EXPECT_FALSE(parse_failure(Bytes(2 + 513)).ok());
}

}  // namespace
}  // namespace pmesh
