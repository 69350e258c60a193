#include "bench/resident_memory.h"

#include <fstream>
#include <string>

#include <malloc.h>

namespace pmesh::bench {
namespace {

// A field such as "VmRSS:" of /proc/self/status, which is in KiB.
std::uint64_t status_field(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::uint64_t kibibytes = 0;
    if (word == name && status >> kibibytes) return 1024 * kibibytes;
  }
  return 0;
}

}  // namespace

std::uint64_t resident_bytes() {
  malloc_trim(0);
  return status_field("VmRSS:");
}

void reset_peak() { std::ofstream("/proc/self/clear_refs") << '5'; }

std::uint64_t peak_resident_bytes() { return status_field("VmHWM:"); }

}  // namespace pmesh::bench
