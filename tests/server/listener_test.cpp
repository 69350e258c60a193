#include "server/net/listener.h"

#include <new>
#include <thread>

#include <gtest/gtest.h>

#include "protocol/messages.h"
#include "server/frames/tcp_session.h"
#include "server/net/refusal_session.h"
#include "tests/server/descriptor_limit.h"
#include "tests/server/running_server.h"
#include "tests/server/sample_file.h"

namespace pmesh {
namespace {

using testing::DescriptorLimit;
using testing::TestClient;

class ListenerTest : public ::testing::Test {
 protected:
  ~ListenerTest() override {
    reactors_.stop();
    if (thread_.joinable()) thread_.join();
  }

  Result<std::shared_ptr<Listener>> bind(const Listener::MakeSession& make_session) {
    return Listener::bind(reactors_, "127.0.0.1:0", {registry_, make_session},
                          {registry_, make_session});
  }
  void run() {
    thread_ = std::thread([this] { reactors_.run(); });
  }

  const TemporaryDirectory directory_;
  const std::unique_ptr<MeshStore> store_ = MeshStore::open(directory_ / "").value();
  CatalogueCache catalogue_{*store_};
  Metrics metrics_;
  AddressCounts addresses_{0};
  const TrustedProxies proxies_;
  CurrentPolicy policy_{make_policy({}).value()};
  Reactors reactors_{1};
  LodService lod_{LodLimits{}};
  Services services_{*store_, catalogue_, lod_, metrics_, addresses_, proxies_, policy_, 0, {}};
  SessionRegistry registry_{10};
  std::thread thread_;
};

TEST_F(ListenerTest, GoesOnWhenASessionCannotBeMade) {
  bool has_memory = false;
  const auto listener = bind([&](Socket& socket) -> std::shared_ptr<Session> {
    if (!std::exchange(has_memory, true)) throw std::bad_alloc();
    return std::make_shared<RefusalSession>(std::move(socket), services_, WireProtocol::http,
                                            "served");
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
  const auto listener = bind([&](Socket& socket) -> std::shared_ptr<Session> {
    const auto session =
        std::make_shared<TcpSession>(std::move(socket), services_, AddressCounts::Slot());
    session->drain();
    return session;
  });
  (*listener)->start();
  run();
  const std::string received = TestClient((*listener)->address()).receive_all();
  FrameParser parser;
  ByteView bytes = as_bytes(received);
  EXPECT_EQ(parser.feed(bytes), FrameStep::done);
  EXPECT_EQ(parser.frame().type, FrameType::hello);
  EXPECT_EQ(parser.feed(bytes), FrameStep::done);
  EXPECT_EQ(parser.frame().type, FrameType::failure);
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
