// For the tests behind proxies, which are scripts:
//   write_requests files SERVED BESIDE    makes the files of tests/hostile/hostile_files.h
//   write_requests smuggling|traversal    prints the requests, one a line, in hex
#include <cstdio>
#include <iostream>
#include <string>

#include "tests/hostile/hostile_files.h"
#include "tests/hostile/requests.h"

namespace {

void print_hex(const std::string& bytes) {
  for (const char c : bytes) std::printf("%02x", static_cast<unsigned char>(c));
  std::puts("");
}

}  // namespace

int main(int argc, char** argv) {
  using namespace pmesh::testing;
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "files" && argc == 4) {
    write_hostile_files(argv[2], argv[3]);
  } else if (what == "smuggling" && argc == 2) {
    for (const HostileRequest& request : smuggling_requests()) print_hex(request.bytes);
    for (const HostileRequest& request : odd_requests()) print_hex(request.bytes);
  } else if (what == "traversal" && argc == 2) {
    for (const std::string& target : traversal_targets()) {
      print_hex("GET " + target + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
    }
  } else {
    std::cerr << "usage: write_requests files SERVED BESIDE | smuggling | traversal\n";
    return 2;
  }
}
