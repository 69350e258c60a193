#include <filesystem>

#include <gtest/gtest.h>

#include "tests/server/running_server.h"
#include "tests/server/sample_file.h"

namespace pmesh {
namespace {

using namespace std::chrono_literals;
using testing::fetch;
using testing::get_request;
using testing::HttpResponse;
using testing::make_sample;
using testing::read_response;
using testing::RunningServer;
using testing::SampleFile;
using testing::TestClient;

class HttpSessionTest : public ::testing::Test {
 protected:
  void serve(const std::function<void(ServerOptions&)>& adjust = {}) {
    running_ = std::make_unique<RunningServer>(adjust);
    running_->directory().write("bunny.pmesh", bunny_.bytes);
  }
  std::string address() { return running_->server().http_address(); }
  std::string file() const { return "/bunny/" + bunny_.hash() + ".pmesh"; }

  /// The answer to bytes that may be no request, and whether the connection ends after it.
  HttpResponse answer_to(const std::string& bytes) {
    TestClient client(address());
    client.send(bytes);
    const HttpResponse response = read_response(client);
    EXPECT_EQ(response.field("Connection"), "close");
    EXPECT_EQ(client.receive_all(), "");
    return response;
  }

  SampleFile bunny_ = make_sample();
  std::unique_ptr<RunningServer> running_;
};

/// More than the socket buffers of both ends hold.
SampleFile large_sample() { return make_sample({8'000'000, 8'000'000}); }

TEST_F(HttpSessionTest, SendsTheFile) {
  serve();
  const HttpResponse response = fetch(address(), file());
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(response.body, bunny_.text());
  EXPECT_NE(response.field("Date"), "");
}

TEST_F(HttpSessionTest, SendsALargeFileWhole) {
  bunny_ = large_sample();
  serve();
  EXPECT_TRUE(fetch(address(), file()).body == bunny_.text());
}

TEST_F(HttpSessionTest, SendsRangesOfAWish) {
  serve();
  const std::uint64_t begin = bunny_.index.chunks[1].offset;
  const HttpResponse response = fetch(address(), file() + "?chunks=1-1", "Range: bytes=10-19\r\n");
  EXPECT_EQ(response.status, 206);
  EXPECT_EQ(response.body, bunny_.text(begin + 10, begin + 20));
}

TEST_F(HttpSessionTest, SendsThePrefixOfAnErrorWish) {
  bunny_ = testing::make_measured_sample();
  serve();
  for (const char* query : {"?error=2", "?error=0.03%25", "?error=0.03%"}) {
    const HttpResponse response = fetch(address(), file() + query);
    EXPECT_EQ(response.body, bunny_.text(0, bunny_.index.chunks[1].end())) << query;
    EXPECT_EQ(response.field("PMesh-Reached"), "1") << query;
  }
  EXPECT_EQ(fetch(address(), file() + "?error=0").field("PMesh-Reached"), "0");
}

TEST_F(HttpSessionTest, AnswersManyRequestsOnOneConnection) {
  serve();
  TestClient client(address());
  for (int i = 0; i < 3; ++i) {
    client.send(get_request(file()));
    EXPECT_EQ(read_response(client).body, bunny_.text());
    client.send(get_request("/nobody"));
    EXPECT_EQ(read_response(client).status, 404);
  }
}

TEST_F(HttpSessionTest, AnswersPipelinedRequestsInOrder) {
  serve();
  TestClient client(address());
  client.send(get_request("/health") + get_request(file()) + get_request("/nobody"));
  EXPECT_EQ(read_response(client).status, 200);
  EXPECT_EQ(read_response(client).body, bunny_.text());
  EXPECT_EQ(read_response(client).status, 404);
}

TEST_F(HttpSessionTest, AnswersARequestThatComesByteByByte) {
  serve();
  TestClient client(address());
  for (const char byte : get_request("/health")) client.send({&byte, 1});
  EXPECT_EQ(read_response(client).status, 200);
}

TEST_F(HttpSessionTest, AnswersHeadWithoutABody) {
  serve();
  TestClient client(address());
  client.send("HEAD " + file() + " HTTP/1.1\r\nHost: x\r\n\r\n" + get_request("/health"));
  EXPECT_EQ(read_response(client, false).field("Content-Length"),
            std::to_string(bunny_.bytes.size()));
  EXPECT_EQ(read_response(client).body, R"({"status":"ok"})");
}

TEST_F(HttpSessionTest, ClosesWhenAsked) {
  serve();
  EXPECT_EQ(answer_to(get_request("/health", "Connection: close\r\n")).status, 200);
  EXPECT_EQ(answer_to("GET /health HTTP/1.0\r\n\r\n").status, 200);
}

TEST_F(HttpSessionTest, RefusesWhatIsNoRequest) {
  serve();
  EXPECT_EQ(answer_to("nonsense\r\n\r\n").status, 400);
  EXPECT_EQ(answer_to("GET /health HTTP/1.1\r\n\r\n").status, 400);
  EXPECT_EQ(answer_to("GET /health HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n").status, 400);
  EXPECT_EQ(answer_to("GET /health HTTP/9.9\r\nHost: a\r\n\r\n").status, 400);
  EXPECT_EQ(answer_to(std::string("\0\0\0\0\r\n\r\n", 8)).status, 400);
}

TEST_F(HttpSessionTest, RefusesBodies) {
  serve();
  EXPECT_EQ(answer_to(get_request("/health", "Content-Length: 5\r\n") + "12345").status, 413);
  EXPECT_EQ(
      answer_to(get_request("/health", "Transfer-Encoding: chunked\r\n") + "0\r\n\r\n").status,
      413);
  EXPECT_GE(answer_to(get_request("/health", "Content-Length: 5\r\nTransfer-Encoding: chunked\r\n"))
                .status,
            400);
}

TEST_F(HttpSessionTest, RefusesHeadersThatAreTooLarge) {
  serve();
  EXPECT_EQ(answer_to(get_request("/health", "X: " + std::string(20'000, 'x') + "\r\n")).status,
            431);
  std::string many;
  for (int i = 0; i < 101; ++i) many += "X: y\r\n";
  EXPECT_EQ(answer_to(get_request("/health", many)).status, 431);
}

TEST_F(HttpSessionTest, RefusesTargetsThatAreTooLong) {
  serve();
  EXPECT_EQ(fetch(address(), "/" + std::string(9'000, 'x')).status, 414);
  EXPECT_EQ(answer_to(get_request("/" + std::string(20'000, 'x'))).status, 414);
}

TEST_F(HttpSessionTest, GivesUpOnASlowRequest) {
  serve([](ServerOptions& options) { options.limits.header_timeout = 50ms; });
  EXPECT_EQ(answer_to("GET /health HT").status, 408);
}

TEST_F(HttpSessionTest, ClosesAnIdleConnection) {
  serve([](ServerOptions& options) { options.limits.idle_timeout = 50ms; });
  TestClient client(address());
  EXPECT_EQ(client.receive_all(), "");
}

TEST_F(HttpSessionTest, ResetsAPeerThatDoesNotRead) {
  bunny_ = large_sample();
  serve([](ServerOptions& options) { options.limits.send_timeout = 50ms; });
  TestClient client(address(), 4096);
  client.send(get_request(file()));
  EXPECT_NE(client.receive(1), "");
  client.wait_for_end();
  EXPECT_LT(client.receive_all().size(), bunny_.bytes.size());
  EXPECT_TRUE(client.was_reset());
}

TEST_F(HttpSessionTest, FinishesATransferOfAReplacedFile) {
  bunny_ = large_sample();
  serve();
  TestClient client(address(), 4096);
  client.send(get_request(file()));
  const std::string first = client.receive(1);
  running_->directory().write("incoming", make_sample().bytes);
  std::filesystem::rename(running_->directory() / "incoming",
                          running_->directory() / "bunny.pmesh");
  EXPECT_EQ(fetch(address(), "/bunny").status, 200);
  EXPECT_EQ(fetch(address(), file()).status, 200);  // the transfer still holds it
  client.send(get_request("/health", "Connection: close\r\n"));
  EXPECT_NE(client.receive_all().find(bunny_.text().substr(1000)), std::string::npos);
}

TEST_F(HttpSessionTest, CutsATransferOfATruncatedFile) {
  bunny_ = large_sample();
  serve();
  TestClient client(address(), 4096);
  client.send(get_request(file()));
  const std::string first = client.receive(1);
  std::filesystem::resize_file(running_->directory() / "bunny.pmesh", 12'000'000);
  EXPECT_LT(client.receive_all().size(), bunny_.bytes.size());
  EXPECT_EQ(fetch(address(), "/bunny").status, 404);
}

TEST_F(HttpSessionTest, RefusesConnectionsBeyondTheLimit) {
  serve([](ServerOptions& options) { options.max_connections = 1; });
  TestClient first(address());
  first.send(get_request("/health"));
  EXPECT_EQ(read_response(first).status, 200);
  const HttpResponse refusal = fetch(address(), "/health");
  EXPECT_EQ(refusal.status, 503);
  EXPECT_EQ(refusal.field("Retry-After"), "1");
}

TEST_F(HttpSessionTest, DrainEndsIdleConnectionsAndTheServer) {
  serve();
  TestClient client(address());
  client.send(get_request("/health"));
  EXPECT_EQ(read_response(client).status, 200);
  running_->server().drain();
  EXPECT_EQ(client.receive_all(), "");
  running_->join();
}

TEST_F(HttpSessionTest, DrainLetsTransfersEnd) {
  bunny_ = large_sample();
  serve();
  TestClient client(address(), 4096);
  client.send(get_request(file()));
  std::string received = client.receive(1);
  running_->server().drain();
  received += client.receive_all();
  EXPECT_TRUE(received.ends_with(bunny_.text()));
  running_->join();
}

TEST_F(HttpSessionTest, DrainCutsTransfersAfterTheGracePeriod) {
  bunny_ = large_sample();
  serve([](ServerOptions& options) { options.drain_grace = 50ms; });
  TestClient client(address(), 4096);
  client.send(get_request(file()));
  EXPECT_NE(client.receive(1), "");
  running_->server().drain();
  running_->join();
  EXPECT_LT(client.receive_all().size(), bunny_.bytes.size());
}

TEST(Server, FirstSignalDrainsAndTheSecondStops) {
  const TemporaryDirectory directory;
  const SampleFile mesh = large_sample();
  directory.write("bunny.pmesh", mesh.bytes);
  ServerOptions options;
  options.directory = directory / "";
  options.http = "127.0.0.1:0";
  const auto server = Server::open(options).value();
  server->handle_signals();
  std::thread running([&] { server->run(); });

  TestClient transfer(server->http_address(), 4096), idle(server->http_address());
  transfer.send(get_request("/bunny/" + mesh.hash() + ".pmesh"));
  EXPECT_NE(transfer.receive(1), "");
  ::kill(::getpid(), SIGTERM);
  EXPECT_EQ(idle.receive_all(), "");  // it drains, and the transfer keeps it running
  ::kill(::getpid(), SIGTERM);
  running.join();
}

TEST(Server, NeedsAddressesThatCanBeBound) {
  const TemporaryDirectory directory;
  ServerOptions options;
  options.directory = directory / "";
  const auto status = [&](const std::string& http) {
    options.http = http;
    const auto server = Server::open(options);
    return server ? ErrorCode{} : server.error().code;
  };
  EXPECT_EQ(status("nonsense"), ErrorCode::usage);
  EXPECT_EQ(status("127.0.0.1:65536"), ErrorCode::usage);
  EXPECT_EQ(status("localhost:80"), ErrorCode::usage);
  options.http = "127.0.0.1:0";
  const auto first = Server::open(options).value();
  EXPECT_EQ(status(first->http_address()), ErrorCode::runtime);
}

}  // namespace
}  // namespace pmesh
