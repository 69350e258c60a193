#include "client/streaming_client.h"

#include <gtest/gtest.h>

#include "core/io/export.h"
#include "core/pm/digest.h"
#include "protocol/apply_wish.h"
#include "tests/client/sample.h"
#include "tests/client/scripted_transport.h"

namespace pmesh {
namespace {

using test::extracted;
using test::other_file;
using test::random_cuts;
using test::sample_file;
using test::sample_index;
using test::ScriptedTransport;
using test::wish;

StreamOptions impatient() {
  StreamOptions options;
  options.retry.first_delay = std::chrono::milliseconds(0);
  return options;
}

Bytes ply_of(StreamingClient& client, const LodRequest& wish) {
  const FileIndex& index = *client.prefix().index();
  EXPECT_TRUE(apply_wish(wish, index, client.mesh()).ok());
  return *format_mesh(ExportFormat::ply, client.mesh().snapshot(), index.header.lattice);
}

TEST(StreamingClient, GivesWhatAnExtractGives) {
  for (const char* query : {"", "faces=100", "faces=3000", "vertices=901", "ratio=0.3",
                            "bytes=20000", "faces=1", "error=2", "error=0"}) {
    ScriptedTransport transport(sample_file());
    StreamingClient client(transport, impatient());
    ASSERT_TRUE(client.fetch(wish(query)).ok()) << query;
    EXPECT_EQ(ply_of(client, wish(query)), extracted(sample_file(), wish(query))) << query;
  }
}

TEST(StreamingClient, DownloadsNoMoreThanTheBlindReadAndTheWish) {
  ScriptedTransport transport(sample_file());
  StreamingClient client(transport, impatient());
  ASSERT_TRUE(client.fetch(wish("faces=5000")).ok());
  const std::uint64_t end = resolve(wish("faces=5000"), sample_index())->end;
  ASSERT_GT(end, kMaxPrologueBytes);
  EXPECT_EQ(client.bytes_fetched(), end);
  ASSERT_EQ(transport.reads.size(), 2u);
  EXPECT_EQ(transport.reads[1].from, kMaxPrologueBytes);
}

TEST(StreamingClient, RefusesAWishThatTheFileCannotHaveOnceItsIndexIsKnown) {
  for (const bool ignores_ranges : {false, true}) {
    ScriptedTransport transport(other_file());
    transport.ignores_ranges = ignores_ranges;
    StreamingClient client(transport, impatient());
    const Status status = client.fetch(wish("error=2"));
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().code, ErrorCode::usage);
    EXPECT_LE(client.bytes_fetched(), transport.block_bytes * 2);
    EXPECT_EQ(client.remedy(), Remedy::none);

    EXPECT_EQ(client.fetch(wish("error=2")).error().code, ErrorCode::usage);
    EXPECT_EQ(transport.reads.size(), 1u);
    EXPECT_TRUE(client.fetch(wish("faces=100")).ok());
  }
}

TEST(StreamingClient, GoesOnForAFinerWish) {
  ScriptedTransport transport(sample_file());
  StreamingClient client(transport, impatient());
  ASSERT_TRUE(client.fetch(wish("faces=100")).ok());
  ASSERT_TRUE(client.fetch(wish("")).ok());
  EXPECT_EQ(client.bytes_fetched(), sample_file().size());
  EXPECT_EQ(transport.opens, 1);
}

TEST(StreamingClient, SurvivesCutsAtRandomPlaces) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    ScriptedTransport transport(sample_file());
    transport.cut_after = random_cuts(seed, 3000);
    StreamingClient client(transport, impatient());
    ASSERT_TRUE(client.fetch(wish("")).ok()) << seed;
    EXPECT_EQ(ply_of(client, wish("")), extracted(sample_file(), wish(""))) << seed;
    // Only the identity check of each new connection is read again.
    EXPECT_LE(client.bytes_fetched(), sample_file().size() + 40 * transport.opens) << seed;
  }
}

TEST(StreamingClient, NeedsNoIdentityCheckWhereTheRemoteTellsItsHash) {
  ScriptedTransport transport(sample_file());
  transport.hash = sample_index().header.content_hash;
  transport.cut_after = random_cuts(1, 3000);
  StreamingClient client(transport, impatient());
  ASSERT_TRUE(client.fetch(wish("")).ok());
  EXPECT_EQ(client.bytes_fetched(), sample_file().size());
}

TEST(StreamingClient, SurvivesCutsByAHostThatIgnoresRanges) {
  ScriptedTransport transport(sample_file());
  transport.ignores_ranges = true;
  int reads = 0;
  transport.cut_after = [&] { return std::size_t(9000 * ++reads); };
  StreamingClient client(transport, impatient());
  ASSERT_TRUE(client.fetch(wish("")).ok());
  EXPECT_EQ(ply_of(client, wish("")), extracted(sample_file(), wish("")));
}

TEST(StreamingClient, StopsAHostThatIgnoresRangesWhereTheWishEnds) {
  ScriptedTransport transport(sample_file());
  transport.ignores_ranges = true;
  StreamingClient client(transport, impatient());
  ASSERT_TRUE(client.fetch(wish("faces=1000")).ok());
  const std::uint64_t end = resolve(wish("faces=1000"), sample_index())->end;
  EXPECT_LT(client.bytes_fetched(), end + transport.block_bytes);
}

TEST(StreamingClient, GivesUpAfterFiveFailuresInARow) {
  ScriptedTransport transport(sample_file());
  transport.open_error = retryable_error(runtime_error("connection refused"));
  StreamingClient client(transport, impatient());
  const Status status = client.fetch(wish(""));
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(transport.opens, 5);
  EXPECT_NE(status.error().message.find("connection refused"), std::string::npos);
}

TEST(StreamingClient, DoesNotRetryAFinalError) {
  ScriptedTransport transport(sample_file());
  transport.open_error = final_error(runtime_error("not found"));
  StreamingClient client(transport, impatient());
  EXPECT_FALSE(client.fetch(wish("")).ok());
  EXPECT_EQ(transport.opens, 1);
  EXPECT_EQ(client.remedy(), Remedy::none);
}

TEST(StreamingClient, KeepsWhatCameBeforeAFailure) {
  ScriptedTransport transport(sample_file());
  transport.file[sample_index().chunks[1].offset + 9] ^= 1;
  StreamingClient client(transport, impatient());
  const Status status = client.fetch(wish(""));
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::verification);
  EXPECT_EQ(client.prefix().chunk_count(), 1u);
  EXPECT_EQ(client.mesh().face_count(), sample_index().chunks[0].faces);
}

TEST(StreamingClient, FetchesADamagedSectionOnceMore) {
  for (const std::size_t section : {0u, 1u, 2u}) {
    ScriptedTransport transport(sample_file());
    const std::uint64_t begin = sample_index().chunks[section].offset;
    transport.file[begin + 9] ^= 1;
    transport.cut_after = [] { return std::size_t(700); };  // so it is pieced together
    StreamOptions options = impatient();
    options.on_retry = [&](const Error& error) {
      if (error.code == ErrorCode::verification) transport.file = sample_file();
    };
    StreamingClient client(transport, options);
    ASSERT_TRUE(client.fetch(wish("")).ok()) << section;
    EXPECT_EQ(ply_of(client, wish("")), extracted(sample_file(), wish("")));
    const std::uint64_t twice = sample_index().chunks[section].bytes + 700;  // and a block's rest
    EXPECT_LE(client.bytes_fetched(), sample_file().size() + twice + 40 * transport.opens);
  }
}

TEST(StreamingClient, FetchesADamagedHeaderOnceMore) {
  ScriptedTransport transport(sample_file());
  transport.file[50] ^= 1;
  StreamOptions options = impatient();
  options.on_retry = [&](const Error&) { transport.file = sample_file(); };
  StreamingClient client(transport, options);
  EXPECT_TRUE(client.fetch(wish("")).ok());
}

TEST(StreamingClient, FetchesASectionThatStaysDamagedNoThirdTime) {
  ScriptedTransport transport(sample_file());
  transport.file[sample_index().chunks[1].offset + 9] ^= 1;
  int retries = 0;
  StreamOptions options = impatient();
  options.on_retry = [&](const Error&) { ++retries; };
  StreamingClient client(transport, options);
  EXPECT_EQ(client.fetch(wish("")).error().code, ErrorCode::verification);
  EXPECT_EQ(retries, 1);
}

TEST(StreamingClient, DoesNotBelieveCountsThatOnlyTheirDigestsBear) {
  FileIndex index = sample_index();
  index.chunks[0].vertices += 1;
  index.chunks[0].faces += 2;
  index.header.content_hash = hash_prologue(write_prologue(index));
  ScriptedTransport transport(sample_file());
  std::ranges::copy(write_prologue(index), transport.file.begin());
  StreamingClient client(transport, impatient());
  const Status status = client.fetch(wish(""));
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::verification) << status.error().message;
}

TEST(StreamingClient, NoticesAFileReplacedUnderTheTransfer) {
  ScriptedTransport transport(sample_file());
  transport.cut_after = [] { return std::size_t(8000); };
  StreamOptions options = impatient();
  options.on_retry = [&](const Error&) { transport.file = other_file(); };
  StreamingClient client(transport, options);
  const Status status = client.fetch(wish(""));
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("another"), std::string::npos);
}

TEST(StreamingClient, NoticesAnotherFileUnderTheHash) {
  ScriptedTransport transport(other_file());
  transport.hash = sample_index().header.content_hash;
  StreamingClient client(transport, impatient());
  EXPECT_FALSE(client.fetch(wish("")).ok());
  EXPECT_FALSE(client.has_mesh());
}

TEST(StreamingClient, RefusesAGapInTheBytes) {
  ScriptedTransport transport(sample_file());
  transport.left_out = 10;
  StreamingClient client(transport, impatient());
  EXPECT_FALSE(client.fetch(wish("")).ok());
}

TEST(StreamingClient, TakesWhatAPartialFileHolds) {
  ScriptedTransport transport(sample_file());
  transport.file.resize(sample_index().chunks[1].end() + 10);
  StreamingClient client(transport, impatient());
  ASSERT_TRUE(client.fetch(wish("")).ok());
  EXPECT_EQ(client.mesh().face_count(), sample_index().chunks[1].faces);
}

TEST(StreamingClient, RefusesAFileCutBeforeTheEndOfItsBase) {
  for (const std::uint64_t size :
       {std::uint64_t{0}, std::uint64_t{100}, sample_index().base_end() - 1}) {
    ScriptedTransport transport(sample_file());
    transport.file.resize(size);
    StreamingClient client(transport, impatient());
    const Status status = client.fetch(wish("faces=1"));
    ASSERT_FALSE(status.ok()) << size;
    EXPECT_EQ(status.error().code, ErrorCode::verification) << size;
  }
}

TEST(StreamingClient, ResumesFromAPrefixWithoutReadingItAgain) {
  ScriptedTransport transport(sample_file());
  transport.hash = sample_index().header.content_hash;
  StreamingClient client(transport, impatient());
  const std::uint64_t held = sample_index().chunks[1].end();
  ASSERT_TRUE(client.resume_from(ByteView(sample_file()).first(held + 7)).ok());
  ASSERT_TRUE(client.fetch(wish("")).ok());
  EXPECT_EQ(client.bytes_fetched(), sample_file().size() - held);
  EXPECT_EQ(ply_of(client, wish("")), extracted(sample_file(), wish("")));
}

TEST(StreamingClient, ReportsGrowingProgress) {
  ScriptedTransport transport(sample_file());
  std::vector<StreamProgress> seen;
  StreamOptions options = impatient();
  options.on_progress = [&](const StreamProgress& progress) { seen.push_back(progress); };
  StreamingClient client(transport, options);
  ASSERT_TRUE(client.fetch(wish("")).ok());
  EXPECT_EQ(seen.back().bytes_held, sample_file().size());
  EXPECT_EQ(seen.back().bytes_wanted, sample_file().size());
  EXPECT_EQ(seen.back().faces, sample_index().header.faces);
  EXPECT_TRUE(std::ranges::is_sorted(seen, {}, &StreamProgress::faces));
}

TEST(StreamingClient, StopsWaitingWhenCancelled) {
  ScriptedTransport transport(sample_file());
  transport.open_error = retryable_error(runtime_error("connection refused"));
  CancelFlag cancel{false};
  StreamOptions options;
  options.retry.first_delay = std::chrono::hours(1);
  options.retry.longest_delay = std::chrono::hours(1);
  options.cancel = &cancel;
  options.on_retry = [&](const Error&) { cancel = true; };
  StreamingClient client(transport, options);
  EXPECT_FALSE(client.fetch(wish("")).ok());
  EXPECT_EQ(transport.opens, 1);
  EXPECT_EQ(client.remedy(), Remedy::try_again);
}

}  // namespace
}  // namespace pmesh
