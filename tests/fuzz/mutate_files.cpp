// Decodes mutated PM files and counts what came of them:
//
//   mutate_files [--count N] [--seed S] [--last FILE] FOLDER
//
// starts from the PM files of FOLDER and from a few that it makes. Each mutation depends on the
// files, the seed and its number alone. It stops, with the culprit in FILE, at the first one that
// decodes to anything but an error or a valid mesh, takes more than 5 s of processor time, or more
// memory than 64 MiB and four times the input; crashes are the sanitizers' to find.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <string>

#include <sys/time.h>

#include "core/pm/base_codec.h"
#include "core/pm/stream_decoder.h"
#include "tests/fixtures/pm_files.h"
#include "tests/fixtures/random_chunks.h"
#include "tests/fixtures/shapes.h"
#include "tests/fuzz/allocation_meter.h"
#include "tests/fuzz/mutation.h"
#include "tests/fuzz/require_sound.h"

namespace {

using namespace pmesh;

constexpr int kMostSeconds = 5;
constexpr std::size_t kMostMemory = std::size_t{64} << 20;

struct Options {
  std::uint64_t count = 10'000;
  std::uint64_t seed = 1;
  const char* last = nullptr;
  const char* folder = nullptr;
};

std::vector<Bytes> read_folder(const char* folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".pmesh") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<Bytes> files;
  for (const auto& path : paths) {
    std::ifstream in(path, std::ios::binary);
    files.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return files;
}

void add_made_files(std::vector<Bytes>& files) {
  using namespace shapes;
  files.push_back(encode_shape("hub", hub(100)).file);
  files.push_back(file_with_arrivals());
  files.push_back(encode_shape("components", components(12)).file);
  files.push_back(encode_shape("ball", bumped(icosphere(3), 0.05)).file);
  files.push_back(encode_relocating_shape("components", components(7)).file);
  files.push_back(encode_relocating_shape("grid", bumped(grid(9, 7), 0.05)).file);
}

std::optional<Options> parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument.rfind("--", 0) != 0) {
      options.folder = argv[i];
    } else if (i + 1 == argc) {
      return {};
    } else if (argument == "--count") {
      options.count = std::strtoull(argv[++i], nullptr, 10);
    } else if (argument == "--seed") {
      options.seed = std::strtoull(argv[++i], nullptr, 10);
    } else if (argument == "--last") {
      options.last = argv[++i];
    } else {
      return {};
    }
  }
  if (options.folder == nullptr) return {};
  return options;
}

// The message without its numbers, so that errors of a kind are counted together.
std::string kind_of(const Error& error) {
  std::string kind;
  for (const char c : error.message) {
    const char shown = c >= '0' && c <= '9' ? '#' : c;
    if (shown != '#' || kind.empty() || kind.back() != '#') kind += shown;
  }
  return kind;
}

// Decodes `file`, fed whole; says what came of it.
std::string decode(const Mutation& mutation) {
  DecodeLimits limits;
  limits.verify_checksums = mutation.verify_checksums;
  StreamDecoder decoder(decode_base, limits);
  const Status fed = decoder.feed(mutation.file);
  if (decoder.has_base()) require_sound(decoder.mesh(), decoder.index().header.lattice.bits);
  if (!fed) return kind_of(fed.error());
  return decoder.complete() ? "complete" : "no error: more is wanted";
}

// SIGPROF ends the program unless it is disarmed within kMostSeconds of processor time.
void arm(int seconds) {
  const itimerval timer{{0, 0}, {seconds, 0}};
  setitimer(ITIMER_PROF, &timer, nullptr);
}

class Tally {
 public:
  void add(const std::string& result, double seconds, std::size_t memory, std::uint64_t number) {
    ++results_[result];
    most_memory_ = std::max(most_memory_, memory);
    if (seconds <= slowest_) return;
    slowest_ = seconds;
    slowest_number_ = number;
  }

  void print() const {
    std::uint64_t total = 0;
    for (const auto& [result, count] : results_) {
      std::printf("%10llu  %s\n", static_cast<unsigned long long>(count), result.c_str());
      total += count;
    }
    std::printf("%llu files; the slowest, number %llu, took %.3f s; most memory %.1f MiB\n",
                static_cast<unsigned long long>(total),
                static_cast<unsigned long long>(slowest_number_), slowest_,
                static_cast<double>(most_memory_) / (1 << 20));
  }

 private:
  std::map<std::string, std::uint64_t> results_;
  double slowest_ = 0;
  std::uint64_t slowest_number_ = 0;
  std::size_t most_memory_ = 0;
};

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void save(const char* path, const Bytes& file) {
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(file.data()), static_cast<std::streamsize>(file.size()));
}

}  // namespace

int main(int argc, char** argv) {
  const std::optional<Options> options = parse(argc, argv);
  if (!options) {
    std::fprintf(stderr, "usage: mutate_files [--count N] [--seed S] [--last FILE] FOLDER\n");
    return 2;
  }
  std::vector<Bytes> files = read_folder(options->folder);
  add_made_files(files);
  const Mutator mutator(std::move(files));
  Tally tally;
  for (std::uint64_t number = 0; number < options->count; ++number) {
    const Mutation mutation = mutator.mutate(options->seed, number);
    if (options->last != nullptr) save(options->last, mutation.file);
    const std::size_t before = allocated_bytes();
    const double start = processor_seconds();
    restart_peak();
    arm(kMostSeconds);
    const std::string result = decode(mutation);
    arm(0);
    const std::size_t memory = peak_bytes() - before;
    tally.add(result, processor_seconds() - start, memory, number);
    if (memory > kMostMemory + 4 * mutation.file.size()) {
      std::fprintf(stderr, "file %llu of %zu bytes took %zu bytes of memory\n",
                   static_cast<unsigned long long>(number), mutation.file.size(), memory);
      return 1;
    }
  }
  tally.print();
  return 0;
}
