// A `pmesh serve` of our own, and what it takes of the system.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sys/types.h>

namespace pmesh::soak {

struct Usage {
  std::int64_t private_bytes = 0;  ///< Memory that no other process shares.
  std::int64_t descriptors = 0;
};

class ServerProcess {
 public:
  /// Runs the command; what it logs goes where this program's errors go. Ends the program if it
  /// cannot.
  explicit ServerProcess(std::vector<std::string> command);
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  Usage usage() const;
  /// Drains it and gives its exit status; -1 if it did not exit by itself.
  int finish();

 private:
  pid_t pid_;
};

/// A TCP port of 127.0.0.1 that nobody listens on.
std::uint16_t free_port();

}  // namespace pmesh::soak
