#include <ctime>
#include <map>

#include "server/access/signed_query.h"
#include "tests/server/descriptor_limit.h"
#include "tests/server/tcp_session_fixture.h"

namespace pmesh {
namespace {

using namespace std::chrono_literals;
using namespace testing;

class TcpSessionTest : public testing::TcpSession {};

TEST_F(TcpSessionTest, OpenedTellsTheCounts) {
  serve();
  connect();
  send(encode_open(7, {.id = "bunny", .hash = {}}));
  const Frame frame = next();
  const FileHeader& header = bunny_.index.header;
  EXPECT_EQ(frame.stream, 7);
  EXPECT_EQ(parse_opened(frame.payload).value(),
            (Opened{header.content_hash, header.file_bytes, header.vertices, header.faces,
                    header.base_vertices, header.base_faces, 3}));
}

TEST_F(TcpSessionTest, WantGivesTheWholeFile) {
  serve();
  connect_and_open();
  want("");
  const Delivery got = delivery();
  EXPECT_EQ(got.begin, 0u);
  EXPECT_EQ(got.bytes, bunny_.text());
  EXPECT_EQ(got.done(), (Done{bunny_.bytes.size(), 76, 40, true}));
}

TEST_F(TcpSessionTest, WantGivesTheBytesOfAWish) {
  serve();
  connect_and_open();
  want("faces=36");
  const std::uint64_t end = bunny_.index.chunks[0].end();
  const Delivery got = delivery();
  EXPECT_EQ(got.bytes, bunny_.text(0, end));
  EXPECT_EQ(got.done(), (Done{end, 36, 20, true}));
}

TEST_F(TcpSessionTest, WantGoesOnFromAnOffset) {
  serve();
  connect_and_open();
  const std::uint64_t from = bunny_.index.chunks[1].offset;
  want("", from);
  const Delivery got = delivery();
  EXPECT_EQ(got.begin, from);
  EXPECT_EQ(got.bytes, bunny_.text(from, bunny_.bytes.size()));
}

TEST_F(TcpSessionTest, WantOfWhatIsThereAlreadyIsDoneAtOnce) {
  serve();
  connect_and_open();
  want("faces=36", bunny_.bytes.size());
  const Delivery got = delivery();
  EXPECT_EQ(got.bytes, "");
  EXPECT_EQ(got.done().end, bunny_.index.chunks[0].end());
}

TEST_F(TcpSessionTest, WantBelowTheBaseIsNotReached) {
  serve();
  connect_and_open();
  want("faces=1");
  EXPECT_FALSE(delivery().done().reached);
}

TEST_F(TcpSessionTest, WantOfAnErrorGivesTheFirstChunkEndNearEnough) {
  bunny_ = testing::make_measured_sample();
  serve();
  connect_and_open();
  const std::uint64_t end = bunny_.index.chunks[1].end();
  for (const char* query : {"error=2", "error=0.03%"}) {
    want(query);
    const Delivery got = delivery();
    EXPECT_EQ(got.bytes, bunny_.text(0, end)) << query;
    EXPECT_EQ(got.done(), (Done{end, 56, 30, true})) << query;
  }
}

TEST_F(TcpSessionTest, WantOfAnErrorOutOfReachGivesTheWholeFile) {
  bunny_ = testing::make_measured_sample();
  serve();
  connect_and_open();
  want("error=0.9");
  const Delivery got = delivery();
  EXPECT_EQ(got.bytes, bunny_.text());
  EXPECT_FALSE(got.done().reached);
}

TEST_F(TcpSessionTest, SendsALargeFileInFramesOfTheAskedSize) {
  bunny_ = large_sample();
  serve();
  connect(4096);
  send(encode_open(1, {.id = "bunny", .hash = {}}));
  next();
  want("");
  EXPECT_LE(next().payload.size(), 4096u);
  EXPECT_TRUE(bunny_.text().ends_with(delivery().bytes));
}

TEST_F(TcpSessionTest, PauseStopsAndResumeGoesOn) {
  bunny_ = large_sample();
  serve();
  connect_and_open();
  want("");
  send(encode_empty(FrameType::pause, 1));
  send(encode_empty(FrameType::ping, 0));
  Delivery first = delivery();  // up to the pong
  EXPECT_EQ(first.answer.type, FrameType::pong);
  EXPECT_LT(first.bytes.size(), bunny_.bytes.size());
  expect_alive();  // nothing comes between

  send(encode_empty(FrameType::resume, 1));
  const Delivery rest = delivery();
  EXPECT_EQ(rest.answer.type, FrameType::done);
  EXPECT_TRUE(first.bytes + rest.bytes == bunny_.text());
}

TEST_F(TcpSessionTest, CancelAnswersTheWant) {
  bunny_ = large_sample();
  serve();
  connect_and_open();
  want("");
  send(encode_empty(FrameType::cancel, 1));
  expect_failure(delivery().answer, 1, FailureCode::cancelled);
  expect_alive();
}

TEST_F(TcpSessionTest, SecondWantReplacesTheFirst) {
  bunny_ = large_sample();
  serve();
  connect_and_open();
  want("");
  want("bytes=0");
  expect_failure(delivery().answer, 1, FailureCode::cancelled);
  const Delivery second = delivery();
  EXPECT_EQ(second.bytes, bunny_.text(0, bunny_.index.base_end()));
  EXPECT_FALSE(second.done().reached);
}

TEST_F(TcpSessionTest, ControlOfNothingIsIgnored) {
  serve();
  connect_and_open();
  for (const FrameType type : {FrameType::pause, FrameType::resume, FrameType::cancel}) {
    send(encode_empty(type, 1));
    send(encode_empty(type, 9));
  }
  expect_alive();
}

TEST_F(TcpSessionTest, BadWishesFailOnTheirStream) {
  serve();
  connect_and_open();
  send(encode_frame(FrameType::want, 1, as_bytes(std::string(8, '\0') + "color=red")));
  expect_failure(1, FailureCode::bad_wish);
  want("chunks=0-99");
  expect_failure(1, FailureCode::bad_wish);
  want("error=1");  // of a mesh without measured errors
  expect_failure(1, FailureCode::bad_wish);
  want("", bunny_.bytes.size() + 1);
  expect_failure(1, FailureCode::bad_wish);
  expect_alive();
}

TEST_F(TcpSessionTest, OpenFailsOnItsStream) {
  serve();
  connect();
  for (const char* id : {"nobody", "", "..", "a/b", "health"}) {
    send(encode_open(1, {.id = id, .hash = {}}));
    expect_failure(1, FailureCode::not_found);
  }
  send(encode_open(1, {.id = "bunny", .hash = ContentHash{}}));
  expect_failure(1, FailureCode::hash_changed);
  send(encode_want(1, {}));
  expect_failure(1, FailureCode::not_open);
  expect_alive();
}

TEST_F(TcpSessionTest, OpenOfAMeshThatCannotBeOpenedNowMayBeTriedAgain) {
  if (!testing::DescriptorLimit::can_leave_none()) GTEST_SKIP() << "sanitizers need descriptors";
  serve();
  connect();
  running_->directory().write("late.pmesh", bunny_.bytes);
  {
    const testing::DescriptorLimit limit(testing::DescriptorLimit::none_left());
    send(encode_open(1, {.id = "late", .hash = {}}));
    expect_failure(1, FailureCode::busy);
  }
  send(encode_open(1, {.id = "late", .hash = {}}));
  EXPECT_EQ(next().type, FrameType::opened);
}

TEST_F(TcpSessionTest, SoManyStreamsCanBeOpen) {
  serve([](ServerOptions& options) { options.limits.streams = 2; });
  connect_and_open();
  send(encode_open(2, {.id = "bunny", .hash = {}}));
  EXPECT_EQ(next().type, FrameType::opened);
  send(encode_open(3, {.id = "bunny", .hash = {}}));
  expect_failure(3, FailureCode::too_many_streams);
  send(encode_want(3, {}));
  expect_failure(3, FailureCode::not_open);
  send(encode_open(1, {.id = "bunny", .hash = bunny_.index.header.content_hash}));
  EXPECT_EQ(next().type, FrameType::opened);
}

TEST_F(TcpSessionTest, StreamsAreServedInTurn) {
  bunny_ = large_sample();
  serve();
  const SampleFile other = make_sample({7'000'000}, 2);
  running_->directory().write("other.pmesh", other.bytes);
  connect_and_open();
  send(encode_open(9, {.id = "other", .hash = {}}));
  EXPECT_EQ(next().type, FrameType::opened);
  send(encode_want(1, {}));
  send(encode_want(9, {}));

  std::map<std::uint16_t, std::string> received;
  std::uint16_t first_done = 0;
  int in_a_row = 0, most_in_a_row = 0;
  std::uint16_t last = 0;
  for (int done = 0; done < 2;) {
    const Frame frame = next();
    if (frame.type == FrameType::done) {
      if (++done == 1) first_done = frame.stream;
      continue;
    }
    ASSERT_EQ(frame.type, FrameType::data);
    const Data data = parse_data(frame.payload).value();
    std::string& bytes = received[frame.stream];
    ASSERT_EQ(data.offset, bytes.size());
    bytes.append(data.bytes.begin(), data.bytes.end());
    in_a_row = frame.stream == last ? in_a_row + 1 : 1;
    last = frame.stream;
    // The first want may be served alone until the second has come.
    if (first_done == 0 && received.size() == 2) most_in_a_row = std::max(most_in_a_row, in_a_row);
  }
  EXPECT_TRUE(received[1] == bunny_.text());
  EXPECT_TRUE(received[9] == other.text());
  EXPECT_EQ(first_done, 9);  // the shorter one
  EXPECT_EQ(most_in_a_row, 1);
}

TEST_F(TcpSessionTest, APauseHoldsUpNoOtherStream) {
  bunny_ = large_sample();
  serve();
  connect_and_open();
  send(encode_open(2, {.id = "bunny", .hash = {}}));
  EXPECT_EQ(next().type, FrameType::opened);
  want("");
  send(encode_empty(FrameType::pause, 1));
  send(encode_want(2, {0, parse_wish("bytes=1000").value()}));
  Frame frame = next();
  while (frame.type == FrameType::data) frame = next();
  EXPECT_EQ(frame.type, FrameType::done);
  EXPECT_EQ(frame.stream, 2);
  send(encode_empty(FrameType::cancel, 1));
  frame = next();
  while (frame.type == FrameType::data) frame = next();
  expect_failure(frame, 1, FailureCode::cancelled);
}

TEST_F(TcpSessionTest, ATokenOpensEverything) {
  serve([](ServerOptions& options) { options.access.tokens = {"0123456789abcdef"}; });
  connect();
  send(encode_open(1, {.id = "bunny", .hash = {}}));
  expect_failure(1, FailureCode::not_allowed);
  send(encode_authorise("0123456789abcdeX"));
  send(encode_open(1, {.id = "bunny", .hash = {}}));
  expect_failure(1, FailureCode::not_allowed);
  send(encode_authorise("0123456789abcdef"));
  send(encode_open(1, {.id = "bunny", .hash = {}}));
  EXPECT_EQ(next().type, FrameType::opened);
}

TEST_F(TcpSessionTest, ASignatureOpensItsMesh) {
  const std::string key(32, 'k');
  serve([&](ServerOptions& options) { options.access.url_key = key; });
  connect();
  const std::string query = sign_query(key, "bunny", std::time(nullptr) + 100);
  send(encode_open(1, {.id = "bunny?" + query, .hash = {}}));
  EXPECT_EQ(next().type, FrameType::opened);
  send(encode_open(2, {.id = "other?" + query, .hash = {}}));
  expect_failure(2, FailureCode::not_allowed);
  send(encode_open(3, {.id = "bunny?" + sign_query(key, "bunny", 1), .hash = {}}));
  expect_failure(3, FailureCode::not_allowed);
}

TEST_F(TcpSessionTest, TakesFramesByteByByte) {
  serve();
  client_ = std::make_unique<TestClient>(running_->server().tcp_address());
  std::string bytes = text(encode_hello({})) + text(encode_open(1, {.id = "bunny", .hash = {}}));
  bytes += text(encode_want(1, {}));
  for (const char byte : bytes) client_->send({&byte, 1});
  EXPECT_EQ(next().type, FrameType::hello);
  EXPECT_EQ(next().type, FrameType::opened);
  EXPECT_EQ(delivery().bytes, bunny_.text());
}

}  // namespace
}  // namespace pmesh
