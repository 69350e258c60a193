// What the hostile tests share: a server of tests/hostile/hostile_files.h, and answers in bulk.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "tests/hostile/hostile_files.h"
#include "tests/server/running_server.h"

namespace pmesh::testing {

class HostileTest : public ::testing::Test {
 protected:
  /// What arrives on a connection that sends `bytes`, up to its end.
  std::string answers_to(const std::string& bytes) const {
    TestClient client(address());
    client.send(bytes);
    return client.receive_all();
  }
  const std::string& address() const { return running_->server().http_address(); }

 private:
  TemporaryDirectory beside_;

 protected:
  std::unique_ptr<RunningServer> running_ =
      std::make_unique<RunningServer>([this](ServerOptions& options) {
        options.max_connections_per_address = 0;  // all come from one
        write_hostile_files(options.directory, beside_ / "");
        options.limits.header_timeout = std::chrono::milliseconds(300);
      });
};

/// Answers in what a connection received.
inline std::size_t count_answers(const std::string& received) {
  std::size_t count = 0;
  for (std::size_t at = received.find("HTTP/1.1 "); at != std::string::npos;
       at = received.find("HTTP/1.1 ", at + 1)) {
    ++count;
  }
  return count;
}

}  // namespace pmesh::testing
