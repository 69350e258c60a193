#include "client/streaming_client.h"

#include <algorithm>
#include <cassert>
#include <string>
#include <thread>
#include <utility>

#include "core/pm/base_codec.h"

namespace pmesh {
namespace {

// The least that tells one PM file from another: everything up to the content hash's end.
constexpr std::size_t kIdentityBytes = kContentHashOffset + sizeof(ContentHash);

Error gave_up(Error error, int failures) {
  error.message += " (gave up after " + std::to_string(failures) + " failures in a row)";
  return error;
}

// Appends the first `count` bytes of the remote file, and what comes along with them, to `start`.
TransportStatus read_start(Transport& transport, std::size_t count, Bytes& start) {
  return transport.read({0, count, {}}, [&](std::uint64_t, ByteView bytes) {
    start.insert(start.end(), bytes.begin(), bytes.end());
    return start.size() < count;
  });
}

}  // namespace

StreamingClient::StreamingClient(Transport& transport, StreamOptions options)
    : transport_(transport),
      options_(std::move(options)),
      prefix_(options_.limits),
      decoder_(decode_base, options_.limits) {}

Status StreamingClient::resume_from(ByteView prefix) {
  assert(prefix_.size() == 0);
  if (Status taken = take(prefix); !taken) return taken;
  prefix_.drop_unfinished();
  return prefix_.has_base() ? Status() : damaged("ends before its base mesh does");
}

Status StreamingClient::fetch(const LodRequest& wish) {
  remedy_ = Remedy::none;
  if (Status sensible = check_wish(wish); !sensible) return bad_bytes(sensible.error()).error;
  int failures = 0;
  Backoff backoff(options_.retry);
  for (;;) {
    remedy_ = Remedy::none;
    const std::uint64_t held = prefix_.size();
    const TransportStatus failed = attempt(wish);
    if (!failed) return {};
    is_open_ = false;
    if (prefix_.size() > held) {
      failures = 0;
      backoff.reset();
    }
    if (failed->retryable || is_cancelled()) remedy_ = Remedy::try_again;
    if (!failed->retryable) return failed->error;
    if (++failures >= options_.retry.max_failures) return gave_up(failed->error, failures);
    if (options_.on_retry) options_.on_retry(failed->error);
    if (!wait(backoff.next(failed->retry_after))) return runtime_error("interrupted");
  }
}

// One go, up to the wish's end or the first failure.
TransportStatus StreamingClient::attempt(const LodRequest& wish) {
  if (!is_open_) {
    if (auto failed = open()) return failed;
  }
  while (!has_all_of(wish)) {
    const std::uint64_t held = prefix_.size();
    if (auto failed = read(wish)) return failed;
    if (prefix_.size() == held && !has_all_of(wish)) {
      return bad_bytes(damaged("the file ends at byte " + std::to_string(held)));
    }
  }
  if (prefix_.has_base()) return std::nullopt;
  return bad_bytes(damaged("the file ends before its base mesh does"));
}

TransportStatus StreamingClient::open() {
  if (auto failed = transport_.open()) return failed;
  is_open_ = true;
  return prefix_.index() ? confirm_same_file() : std::nullopt;
}

TransportStatus StreamingClient::confirm_same_file() {
  if (transport_.remote().hash) {
    const Status same = check_hash(*transport_.remote().hash);
    return same ? std::nullopt : TransportStatus(bad_bytes(same.error()));
  }
  Bytes start;
  const TransportStatus failed = read_start(transport_, kIdentityBytes, start);
  bytes_fetched_ += start.size();
  if (failed) return failed;
  start.resize(std::min(start.size(), kIdentityBytes));
  if (std::ranges::equal(start, prefix_.verified().first(kIdentityBytes))) return std::nullopt;
  return bad_bytes(another_file("its header differs"));
}

TransportStatus StreamingClient::read(const LodRequest& wish) {
  failure_ = {};
  is_section_bad_ = false;
  const ReadRequest request{prefix_.size(), end_of(wish), wish, prefix_.index()};
  const TransportStatus failed = transport_.read(
      request, [&](std::uint64_t offset, ByteView bytes) { return accept(wish, offset, bytes); });
  return failure_.ok() ? failed : judge(failure_.error());
}

// A section may have been pieced together from several answers, or damaged on one way only: the
// first time that it does not match its digest says little.
TransportError StreamingClient::judge(const Error& error) {
  if (!is_section_bad_ || second_try_ == prefix_.size()) return bad_bytes(error);
  second_try_ = prefix_.size();
  return retryable_error(bad_bytes(error).error);
}

bool StreamingClient::accept(const LodRequest& wish, std::uint64_t offset, ByteView bytes) {
  bytes_fetched_ += bytes.size();
  if (offset > prefix_.size()) {
    failure_ = runtime_error("the remote left out bytes " + std::to_string(prefix_.size()) +
                             " to " + std::to_string(offset));
    return false;
  }
  const std::uint64_t known = prefix_.size() - offset;
  if (known >= bytes.size()) return true;
  failure_ = take(bytes.subspan(static_cast<std::size_t>(known)));
  if (failure_.ok()) failure_ = check_wish(wish);
  report_progress(wish);
  return failure_.ok() && !has_all_of(wish);
}

Status StreamingClient::take(ByteView bytes) {
  const Status appended = prefix_.append(bytes);
  if (prefix_.index() && transport_.remote().hash) {
    if (Status same = check_hash(*transport_.remote().hash); !same) return same;
  }
  const ByteView whole = prefix_.verified().subspan(static_cast<std::size_t>(decoder_.fed_bytes()));
  if (Status decoded = decoder_.feed(whole); !decoded) return decoded.error();
  is_section_bad_ = !appended && appended.error().code == ErrorCode::verification;
  return appended;
}

// Whether the file can give what `wish` names; nothing is said before its index is known.
Status StreamingClient::check_wish(const LodRequest& wish) const {
  if (!prefix_.index()) return {};
  const Result<Resolution> resolution = resolve(wish, *prefix_.index());
  return resolution ? Status() : Status(resolution.error());
}

Status StreamingClient::check_hash(const ContentHash& remote) {
  const ContentHash& begun = prefix_.index()->header.content_hash;
  if (remote == begun) return {};
  return another_file("its hash is " + to_hex(remote) + ", not " + to_hex(begun));
}

Error StreamingClient::another_file(const std::string& how) {
  remedy_ = Remedy::start_over;
  return runtime_error("the remote file is another than the one begun: " + how);
}

TransportError StreamingClient::bad_bytes(const Error& error) const {
  return final_error(options_.name.empty() ? error : prefixed(options_.name, error));
}

// Where the bytes for `wish` end: at the remote's end, if it has less of the file. Nothing if that
// is not known, or check_wish() fails.
std::optional<std::uint64_t> StreamingClient::end_of(const LodRequest& wish) const {
  if (!prefix_.index()) return std::nullopt;
  const Result<Resolution> resolution = resolve(wish, *prefix_.index());
  if (!resolution) return std::nullopt;
  return std::min(resolution->end, transport_.remote().available_bytes.value_or(resolution->end));
}

bool StreamingClient::has_all_of(const LodRequest& wish) const {
  const std::optional<std::uint64_t> end = end_of(wish);
  return end && prefix_.size() >= *end;
}

void StreamingClient::report_progress(const LodRequest& wish) const {
  if (!options_.on_progress) return;
  options_.on_progress(
      {prefix_.size(), end_of(wish).value_or(0), has_mesh() ? decoder_.mesh().face_count() : 0u});
}

// False if cancelled meanwhile.
bool StreamingClient::wait(std::chrono::milliseconds delay) const {
  constexpr std::chrono::milliseconds kCancelPoll{50};
  for (; delay.count() > 0 && !is_cancelled(); delay -= kCancelPoll) {
    std::this_thread::sleep_for(std::min(delay, kCancelPoll));
  }
  return !is_cancelled();
}

}  // namespace pmesh
