#include "server/lod/lod_service.h"

#include <atomic>
#include <filesystem>
#include <future>
#include <latch>
#include <optional>

#include <gtest/gtest.h>

#include "tests/server/opened_mesh.h"

namespace pmesh {
namespace {

using testing::OpenedMesh;

LodJob job(const OpenedMesh& opened, const std::string& query, LodFormat format = LodFormat::ply) {
  return {opened.mesh(), parse_wish(query).value(), format};
}

/// The same, asked for by somebody at this address.
LodJob job_of(const char* client, const OpenedMesh& opened, const std::string& query) {
  LodJob wanted = job(opened, query);
  wanted.client = boost::asio::ip::make_address(client);
  return wanted;
}

/// Asks and waits.
LodOutcome outcome_of(LodService& service, const LodJob& wanted) {
  std::promise<LodOutcome> answer;
  service.get(wanted, [&](const LodOutcome& outcome) { answer.set_value(outcome); });
  return answer.get_future().get();
}
Result<LodFilePtr> asked(LodService& service, const LodJob& wanted) {
  return outcome_of(service, wanted).file;
}

/// Holds the only worker of a service until released, in the answer to a request.
class HeldWorker {
 public:
  HeldWorker(LodService& service, const LodJob& wanted) {
    service.get(wanted, [gates = gates_](const LodOutcome&) {
      gates->held.count_down();
      gates->released.wait();
    });
    gates_->held.wait();
  }
  ~HeldWorker() { release(); }
  void release() {
    if (!gates_->released.try_wait()) gates_->released.count_down();
  }

 private:
  struct Gates {
    std::latch held{1};
    std::latch released{1};
  };
  const std::shared_ptr<Gates> gates_ = std::make_shared<Gates>();  // the worker may leave later
};

/// Answers as they come.
struct Answers {
  std::atomic<int> files = 0;
  std::atomic<int> errors = 0;

  LodService::Done done() {
    return [this](const LodOutcome& outcome) { ++(outcome.file ? files : errors); };
  }
};

TEST(LodService, GivesWhatExportLodGives) {
  const OpenedMesh opened(testing::closed_shape());
  LodService service({});
  const auto lod = asked(service, job(opened, "faces=500"));
  const auto expected =
      export_lod(*opened.mesh(), parse_wish("faces=500").value(), LodFormat::ply, 1000);
  EXPECT_EQ((*lod)->bytes, expected->bytes);
  EXPECT_EQ((*lod)->faces, expected->faces);
  EXPECT_EQ(service.statistics().made, 1u);
  EXPECT_GT(service.statistics().seconds, 0);
}

TEST(LodService, KeepsAFileForAllWishesThatComeToIt) {
  const OpenedMesh opened(testing::closed_shape());
  LodService service({});
  const auto first = asked(service, job(opened, "faces=500"));
  EXPECT_EQ(*asked(service, job(opened, "faces=501")), *first);
  EXPECT_EQ(*asked(service, job(opened, "vertices=252")), *first);
  EXPECT_NE(*asked(service, job(opened, "faces=500", LodFormat::drc)), *first);
  EXPECT_EQ(service.statistics().hits, 2u);
  EXPECT_EQ(service.statistics().made, 2u);
  EXPECT_GE(service.statistics().cached_bytes, (*first)->bytes.size());
}

TEST(LodService, SaysOfEachWishWhetherItIsReached) {
  const OpenedMesh opened(testing::closed_shape());
  LodService service({});
  const std::uint64_t base = opened.index().header.base_faces;
  EXPECT_FALSE((*asked(service, job(opened, "faces=1")))->reached);
  EXPECT_TRUE((*asked(service, job(opened, "faces=" + std::to_string(base))))->reached);
}

TEST(LodService, KeepsNothingWithoutACache) {
  const OpenedMesh opened(testing::closed_shape());
  LodService service({.cache_bytes = 0});
  asked(service, job(opened, "faces=500")).value();
  asked(service, job(opened, "faces=500")).value();
  EXPECT_EQ(service.statistics().made, 2u);
}

TEST(LodService, MakesOnceWhatSeveralAskForMeanwhile) {
  const OpenedMesh opened(testing::closed_shape());
  Answers answers;
  {
    LodService service({.cache_bytes = 0});
    HeldWorker held(service, job(opened, "faces=100"));
    for (int i = 0; i < 5; ++i) service.get(job(opened, "faces=500"), answers.done());
    EXPECT_EQ(service.statistics().merged, 4u);
    EXPECT_EQ(service.statistics().queued, 1u);
    held.release();
    asked(service, job(opened, "faces=600")).value();
    EXPECT_EQ(service.statistics().made, 3u);
  }
  EXPECT_EQ(answers.files, 5);
}

TEST(LodService, RefusesWhatTheQueueHasNoPlaceFor) {
  const OpenedMesh opened(testing::closed_shape());
  Answers answers;
  LodService service({.queue = 2});
  HeldWorker held(service, job(opened, "faces=100"));
  service.get(job(opened, "faces=200"), answers.done());
  service.get(job(opened, "faces=300"), answers.done());
  const LodOutcome refused = outcome_of(service, job(opened, "faces=400"));
  EXPECT_EQ(refused.file.error().code, ErrorCode::out_of_resources);
  EXPECT_EQ(refused.limit, LimitName::lod_queue);
  EXPECT_EQ(service.statistics().refused, 1u);
  service.get(job(opened, "faces=300"), answers.done());  // merged: takes no place
  EXPECT_EQ(answers.errors, 0);
}

TEST(LodService, GivesEachAddressItsPartOfTheQueue) {
  const OpenedMesh opened(testing::closed_shape());
  Answers answers;
  LodService service({.per_address = 2});
  const auto kept = asked(service, job(opened, "faces=500"));
  HeldWorker held(service, job(opened, "faces=100"));
  const char* greedy = "192.0.2.1";
  service.get(job_of(greedy, opened, "faces=200"), answers.done());
  service.get(job_of(greedy, opened, "faces=300"), answers.done());
  const LodOutcome refused = outcome_of(service, job_of(greedy, opened, "faces=400"));
  EXPECT_EQ(refused.file.error().code, ErrorCode::out_of_resources);
  EXPECT_EQ(refused.limit, LimitName::lod_per_address);
  EXPECT_EQ(service.statistics().refused, 1u);

  service.get(job_of("192.0.2.2", opened, "faces=400"), answers.done());
  service.get(job_of(greedy, opened, "faces=400"), answers.done());  // merged: takes no place
  EXPECT_EQ(*asked(service, job_of(greedy, opened, "faces=500")), *kept);
  held.release();
  asked(service, job(opened, "faces=600")).value();  // behind all of them
  EXPECT_TRUE(asked(service, job_of(greedy, opened, "faces=700")).ok());
  EXPECT_EQ(answers.files, 4);
}

TEST(LodService, AnswersHitsWhileItsWorkersAreBusy) {
  const OpenedMesh opened(testing::closed_shape());
  LodService service({});
  const auto first = asked(service, job(opened, "faces=500"));
  HeldWorker held(service, job(opened, "faces=100"));
  EXPECT_EQ(*asked(service, job(opened, "faces=500")), *first);
}

TEST(LodService, RefusesAWishBeforeItWaits) {
  const OpenedMesh opened(testing::closed_shape());
  LodService service({.queue = 0, .faces = 100});
  for (const char* query : {"faces=500", "chunks=1-1", "error=1"}) {
    EXPECT_EQ(asked(service, job(opened, query)).error().code, ErrorCode::usage) << query;
  }
  EXPECT_EQ(service.statistics().refused, 0u);
}

TEST(LodService, KeepsNoError) {
  const OpenedMesh opened(testing::closed_shape());
  const auto written = std::filesystem::last_write_time(opened.path());
  LodService service({});
  std::filesystem::last_write_time(opened.path(), written - std::chrono::seconds(1));
  EXPECT_FALSE(asked(service, job(opened, "faces=500")).ok());
  EXPECT_EQ(service.statistics().failed, 1u);
  std::filesystem::last_write_time(opened.path(), written);
  EXPECT_TRUE(asked(service, job(opened, "faces=500")).ok());
}

TEST(LodService, AnswersAllWhenItEnds) {
  const OpenedMesh opened(testing::closed_shape());
  Answers answers;
  {
    std::optional<LodService> service(std::in_place, LodLimits{});
    HeldWorker held(*service, job(opened, "faces=100"));
    for (int i = 2; i < 10; ++i) {
      service->get(job(opened, "faces=" + std::to_string(100 * i)), answers.done());
    }
    std::thread ending([&] { service.reset(); });
    held.release();
    ending.join();
  }
  EXPECT_EQ(answers.files + answers.errors, 8);
}

TEST(LodService, AnswersEveryRequestOfManyThreadsOnce) {
  const OpenedMesh closed(testing::closed_shape()), open(testing::open_shape());
  LodService service({.workers = 3, .queue = 1000, .cache_bytes = 200'000});
  std::latch answered(200);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 50; ++i) {
        const OpenedMesh& opened = (t + i) % 2 == 0 ? closed : open;
        service.get(job(opened, "faces=" + std::to_string(50 + 37 * (i % 7))),
                    [&](const LodOutcome& outcome) {
                      EXPECT_TRUE(outcome.file.ok());
                      answered.count_down();  // beyond 200 is misuse of a latch
                    });
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  answered.wait();
  const LodStatistics counts = service.statistics();
  EXPECT_EQ(counts.hits + counts.merged + counts.made, 200u);
  EXPECT_LE(counts.cached_bytes, 200'000u);
}

}  // namespace
}  // namespace pmesh
