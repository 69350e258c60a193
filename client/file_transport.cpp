#include "client/file_transport.h"

#include <algorithm>
#include <utility>

namespace pmesh {
namespace {

constexpr std::uint64_t kBlockBytes = 256 * 1024;

}  // namespace

FileTransport::FileTransport(std::string path, const TransportOptions& options)
    : path_(std::move(path)), cancel_(options.cancel) {}

TransportStatus FileTransport::open() {
  file_.reset();
  Result<RandomAccessFile> file = RandomAccessFile::open(path_);
  if (!file) return final_error(file.error());
  file_.emplace(std::move(*file));
  remote_.available_bytes = file_->size();
  return std::nullopt;
}

TransportStatus FileTransport::read(const ReadRequest& request, const ByteSink& sink) {
  const std::uint64_t asked = request.end.value_or(request.from + kMaxPrologueBytes);
  const std::uint64_t end = std::min(asked, file_->size());
  Bytes block;
  for (std::uint64_t offset = request.from; offset < end; offset += block.size()) {
    if (cancel_ != nullptr && cancel_->load()) return final_error(runtime_error("interrupted"));
    block.resize(static_cast<std::size_t>(std::min(kBlockBytes, end - offset)));
    if (Status status = file_->read(offset, block); !status) return final_error(status.error());
    if (!sink(offset, block)) break;
  }
  return std::nullopt;
}

}  // namespace pmesh
