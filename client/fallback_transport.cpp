#include "client/fallback_transport.h"

#include <utility>

namespace pmesh {
namespace {

constexpr int kMostFailures = 2;

}  // namespace

FallbackTransport::FallbackTransport(std::unique_ptr<Transport> first,
                                     std::unique_ptr<Transport> second)
    : current_(std::move(first)), second_(std::move(second)) {}

TransportStatus FallbackTransport::open() { return judge(current_->open()); }

TransportStatus FallbackTransport::read(const ReadRequest& request, const ByteSink& sink) {
  bool has_given = false;
  TransportStatus failed = current_->read(request, [&](std::uint64_t offset, ByteView bytes) {
    has_given = true;
    return sink(offset, bytes);
  });
  if (has_given) failures_ = 0;
  return has_given && failed && !failed->wants_other_wire ? failed : judge(std::move(failed));
}

TransportStatus FallbackTransport::judge(TransportStatus failed) {
  if (!failed || !second_) return failed;
  if (failed->retryable) ++failures_;
  if (!failed->wants_other_wire && failures_ < kMostFailures) return failed;
  current_ = std::move(second_);
  failed->retryable = true;
  failed->error.message += "; going on over plain HTTP";
  return failed;
}

}  // namespace pmesh
