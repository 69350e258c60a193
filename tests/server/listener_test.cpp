#include "server/net/listener.h"

#include <new>
#include <thread>

#include <boost/asio/strand.hpp>
#include <gtest/gtest.h>

#include "protocol/messages.h"
#include "server/net/refusal_session.h"
#include "server/frames/tcp_session.h"
#include "tests/server/descriptor_limit.h"
#include "tests/server/running_server.h"
#include "tests/server/sample_file.h"

namespace pmesh {
namespace {

using boost::asio::ip::tcp;
using testing::DescriptorLimit;
using testing::TestClient;

class ListenerTest : public ::testing::Test {
 protected:
  ~ListenerTest() override {
    context_.stop();
    if (thread_.joinable()) thread_.join();
  }

  Result<std::shared_ptr<Listener>> bind(const Listener::MakeSession& make_session) {
    return Listener::bind(context_, "127.0.0.1:0", registry_, make_session, make_session);
  }
  void run() {
    thread_ = std::thread([this] { context_.run(); });
  }

  const SessionLimits limits_;
  boost::asio::io_context context_;
  SessionRegistry registry_{10};
  std::thread thread_;
};

TEST_F(ListenerTest, GoesOnWhenASessionCannotBeMade) {
  bool has_memory = false;
  const auto listener = bind([&](tcp::socket socket) -> std::shared_ptr<Session> {
    if (!std::exchange(has_memory, true)) throw std::bad_alloc();
    return std::make_shared<RefusalSession>(std::move(socket), limits_, "served");
  });
  (*listener)->start();
  run();
  EXPECT_EQ(TestClient((*listener)->address()).receive_all(), "");
  EXPECT_EQ(TestClient((*listener)->address()).receive_all(), "served");
}

TEST_F(ListenerTest, SaysThatDescriptorsRanOut) {
  if (!DescriptorLimit::can_leave_none()) GTEST_SKIP() << "sanitizers need descriptors";
  const auto first = bind({});  // for which Asio opens what it needs itself
  const DescriptorLimit limit(DescriptorLimit::none_left());
  EXPECT_EQ(bind({}).error().code, ErrorCode::out_of_resources);
}

TEST_F(ListenerTest, TcpSessionGreetsEvenIfDrainedBeforeItRuns) {
  const TemporaryDirectory directory;
  const auto store = MeshStore::open(directory / "").value();
  tcp::acceptor acceptor(context_, {boost::asio::ip::address_v4::loopback(), 0});
  TestClient client(":" + std::to_string(acceptor.local_endpoint().port()));
  tcp::socket socket(boost::asio::make_strand(context_));
  acceptor.accept(socket);
  const auto session = std::make_shared<TcpSession>(std::move(socket), limits_, *store);
  session->drain();
  session->start([] {});
  run();

  const std::string received = client.receive_all();
  FrameParser parser;
  ByteView bytes = as_bytes(received);
  EXPECT_EQ(parser.feed(bytes), FrameStep::done);
  EXPECT_EQ(parser.frame().type, FrameType::hello);
  EXPECT_EQ(parser.feed(bytes), FrameStep::done);
  EXPECT_EQ(parser.frame().type, FrameType::failure);
  context_.stop();
  thread_.join();  // before the store goes
}

TEST(Server, StartsWithMoreMeshesThanDescriptors) {
  const TemporaryDirectory directory;
  const Bytes mesh = testing::make_sample().bytes;
  for (int i = 0; i < 80; ++i) directory.write(std::to_string(i) + ".pmesh", mesh);
  const DescriptorLimit limit(60);
  ServerOptions options;
  options.directory = directory / "";
  options.http = options.tcp = "127.0.0.1:0";
  EXPECT_TRUE(Server::open(options).ok());
}

TEST(Server, SaysThatDescriptorsRanOut) {
  if (!DescriptorLimit::can_leave_none()) GTEST_SKIP() << "sanitizers need descriptors";
  const TemporaryDirectory directory;
  ServerOptions options;
  options.directory = directory / "";
  options.http = options.tcp = "127.0.0.1:0";
  for (int spare = 0; spare < 4; ++spare) {
    const DescriptorLimit limit(DescriptorLimit::none_left() + spare);
    EXPECT_EQ(Server::open(options).error().code, ErrorCode::out_of_resources) << spare;
  }
}

}  // namespace
}  // namespace pmesh
