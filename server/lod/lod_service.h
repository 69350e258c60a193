// Finished levels of detail for all who ask: made by threads of its own, each once for all that ask
// for it at the same time, kept in memory, and bounded in every respect (LodLimits).
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>
#include <thread>
#include <vector>

#include <boost/asio/ip/address.hpp>

#include "core/base/result.h"
#include "protocol/lod_format.h"
#include "protocol/lod_request.h"
#include "server/lod/lod_cache.h"
#include "server/lod/lod_export.h"
#include "server/metrics/metrics.h"
#include "server/net/address_counts.h"
#include "server/options.h"
#include "server/store/mesh_file.h"

namespace pmesh {

struct LodJob {
  MeshPtr mesh;  ///< Not null; held until the job is done.
  LodRequest wish;
  LodFormat format = LodFormat::glb;
  /// Who asks, and gets no more than LodLimits::per_address at once; nothing: any number.
  std::optional<boost::asio::ip::address> client{};
};

/// What came of a job.
struct LodOutcome {
  Result<LodFilePtr> file;
  std::optional<LimitName> limit{};  ///< That it met.
};

/// Every request counts once as a hit, merged, refused, or one to make; those with a wish that is
/// refused do not count.
struct LodStatistics {
  std::uint64_t made = 0;
  std::uint64_t failed = 0;
  std::uint64_t hits = 0;
  std::uint64_t merged = 0;   ///< Waited for what another had asked for.
  std::uint64_t refused = 0;  ///< The queue, or the client's part of it, was full.
  std::size_t queued = 0;     ///< Now, without those being made.
  std::size_t cached_bytes = 0;
  double seconds = 0;  ///< Spent making, by all workers together.
};

/// Threads: get() and statistics() may be called at the same time.
class LodService {
 public:
  using Done = std::function<void(const LodOutcome&)>;

  /// Starts `limits.workers` threads, which must be at least one.
  explicit LodService(const LodLimits& limits);

  /// Finishes what is being made; what waits in the queue is answered by an error (runtime).
  ~LodService();
  LodService(const LodService&) = delete;
  LodService& operator=(const LodService&) = delete;

  /// Calls `done` exactly once: on the calling thread before get() returns, or on a worker's, which
  /// it must not hold up. Wishes for the same LOD in the same format share one file. Errors are
  /// those of export_lod(), and out_of_resources with its limit if there is no place in the queue.
  /// No error is kept: the next request tries again.
  void get(const LodJob& job, Done done);

  LodStatistics statistics() const;

 private:
  struct Work {
    LodJob job;  // with the canonical wish; unchanged while a worker reads it
    AddressCounts::Slot place;
    std::vector<Done> waiting{};
  };
  using WorkMap = std::map<LodKey, Work>;

  /// The answer, if there is one at once; else `done` is taken.
  std::optional<LodOutcome> answer_or_enqueue(const LodKey& key, LodJob job, Done& done);
  LodOutcome refuse(LimitName limit, std::string_view why);
  void work();
  void finish(WorkMap::iterator place, const Result<LodFilePtr>& made, double seconds);
  void keep(const LodKey& key, const LodFilePtr& file);

  const LodLimits limits_;
  AddressCounts clients_;
  mutable std::mutex mutex_;  // guards all below but the threads
  std::condition_variable changed_;
  bool stopping_ = false;
  WorkMap under_way_;  // queued, or being made
  std::deque<WorkMap::iterator> queue_;
  LodCache cache_;
  LodStatistics counts_;  // but for `queued` and `cached_bytes`
  std::vector<std::thread> workers_;
};

}  // namespace pmesh
