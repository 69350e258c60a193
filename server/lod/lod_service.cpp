#include "server/lod/lod_service.h"

#include <cassert>
#include <chrono>
#include <utility>

#include "core/files/out_of_memory.h"

namespace pmesh {
namespace {

Result<LodFilePtr> make(const LodKey& key, const LodJob& job, std::uint64_t most_faces) {
  return catching_out_of_memory([&]() -> Result<LodFilePtr> {
    Result<LodFile> lod = export_lod(*job.mesh, job.wish, job.format, most_faces);
    if (!lod) return lod.error();
    lod->reached = key.reached;  // the canonical wish is for what is there
    return std::make_shared<const LodFile>(std::move(*lod));
  });
}

void tell(const std::vector<LodService::Done>& waiting, const LodOutcome& outcome) {
  for (const LodService::Done& done : waiting) done(outcome);
}

}  // namespace

LodService::LodService(const LodLimits& limits)
    : limits_(limits), clients_(limits.per_address), cache_(limits.cache_bytes) {
  assert(limits.workers > 0);
  for (unsigned i = 0; i < limits.workers; ++i) workers_.emplace_back([this] { work(); });
}

LodService::~LodService() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  for (std::thread& worker : workers_) worker.join();
  for (const auto& [key, work] : under_way_) {
    tell(work.waiting, {runtime_error("the server is shutting down")});
  }
}

void LodService::get(const LodJob& job, Done done) {
  const FileIndex& index = job.mesh->index();
  const Result<Resolution> level = resolve_lod(job.wish, index, limits_.faces);
  if (!level) return done({level.error()});
  const LodRequest wish = canonical_wish(job.wish, *level, index);
  const LodKey key{job.mesh->hash(), job.format, to_query(wish), level->reached};
  const auto answer = answer_or_enqueue(key, {job.mesh, wish, job.format, job.client}, done);
  if (answer) done(*answer);
}

std::optional<LodOutcome> LodService::answer_or_enqueue(const LodKey& key, LodJob job, Done& done) {
  const std::lock_guard lock(mutex_);
  if (LodFilePtr kept = cache_.find(key)) {
    ++counts_.hits;
    return LodOutcome{kept};
  }
  if (const auto found = under_way_.find(key); found != under_way_.end()) {
    found->second.waiting.push_back(std::move(done));
    ++counts_.merged;
    return std::nullopt;
  }
  auto slot = job.client ? clients_.enter(*job.client) : AddressCounts::Slot();
  if (!slot) return refuse(LimitName::lod_per_address, "the client waits for too many levels");
  if (queue_.size() >= limits_.queue) {
    return refuse(LimitName::lod_queue, "too many levels of detail are waiting to be made");
  }
  const auto place = under_way_.try_emplace(key, Work{std::move(job), std::move(*slot)}).first;
  place->second.waiting.push_back(std::move(done));
  queue_.push_back(place);
  changed_.notify_one();
  return std::nullopt;
}

/// Needs the mutex.
LodOutcome LodService::refuse(LimitName limit, std::string_view why) {
  ++counts_.refused;
  return {Error{ErrorCode::out_of_resources, std::string(why)}, limit};
}

LodStatistics LodService::statistics() const {
  const std::lock_guard lock(mutex_);
  LodStatistics now = counts_;
  now.queued = queue_.size();
  now.cached_bytes = cache_.bytes();
  return now;
}

void LodService::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopping_ || !queue_.empty(); });
    if (stopping_) return;
    const WorkMap::iterator place = queue_.front();
    queue_.pop_front();
    lock.unlock();
    const auto begin = std::chrono::steady_clock::now();
    const Result<LodFilePtr> made = make(place->first, place->second.job, limits_.faces);
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    finish(place, made, spent.count());
    lock.lock();
  }
}

void LodService::finish(WorkMap::iterator place, const Result<LodFilePtr>& made, double seconds) {
  WorkMap::node_type finished;
  {
    const std::lock_guard lock(mutex_);
    counts_.seconds += seconds;
    ++(made ? counts_.made : counts_.failed);
    if (made) keep(place->first, *made);
    finished = under_way_.extract(place);
  }
  Work& work = finished.mapped();
  work.place = {};  // who is told may ask for the next one at once
  tell(work.waiting, {made});
}

void LodService::keep(const LodKey& key, const LodFilePtr& file) {
  // Without the memory to note it, it is made again for the next one who asks.
  [[maybe_unused]] const Status kept = catching_out_of_memory([&] {
    cache_.put(key, file);
    return Status();
  });
}

}  // namespace pmesh
