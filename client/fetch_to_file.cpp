#include "client/fetch_to_file.h"

#include <algorithm>

#include <sys/stat.h>

#include "core/files/atomic_file.h"
#include "core/files/read_file.h"
#include "core/io/export.h"
#include "protocol/apply_wish.h"
#include "protocol/mesh_id.h"

namespace pmesh {
namespace {

// 0 if there is no such file.
std::uint64_t size_on_disk(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
}

// Fails now if the output could not be written at the end.
Status check_writable(const std::string& path) {
  const Result<AtomicFile> probe = AtomicFile::create(path, Overwrite::yes);
  return probe ? Status() : Status(probe.error());
}

FetchReport report_of(const StreamingClient& client) {
  const FileHeader& header = client.prefix().index()->header;
  FetchReport report;
  report.hash = header.content_hash;
  report.bytes_fetched = client.bytes_fetched();
  report.bytes_total = header.file_bytes;
  report.complete = client.prefix().verified().size() == header.file_bytes;
  return report;
}

Result<FetchReport> fetch_mesh(StreamingClient& client, const FetchJob& job) {
  if (Status fetched = client.fetch(job.wish); !fetched) {
    Error error = fetched.error();
    if (client.remedy() == Remedy::start_over) error.message += "; run again to fetch the new one";
    return error;
  }
  const FileIndex& index = *client.prefix().index();
  const Result<AppliedWish> applied = apply_wish(job.wish, index, client.mesh());
  if (!applied) return applied.error();
  const Status written = export_mesh(job.output, client.mesh().snapshot(), index.header.lattice);
  if (!written) return written.error();
  FetchReport report = report_of(client);
  report.faces = applied->faces;
  report.vertices = applied->vertices;
  report.reached = applied->reached;
  return report;
}

// A fetch into a partial PM file: what was there before, and what it comes to.
class PrefixFetch {
 public:
  PrefixFetch(StreamingClient& client, const FetchJob& job)
      : client_(client), job_(job), bytes_before_(size_on_disk(job.output)) {}

  Result<FetchReport> run() {
    if (Status resumed = resume(); !resumed) return resumed.error();
    if (Status fetched = client_.fetch(job_.wish); !fetched) {
      const bool is_mistake = fetched.error().code == ErrorCode::usage;
      return is_mistake ? fetched.error() : keep_progress(fetched.error());
    }
    const Result<Resolution> wished = resolve(job_.wish, *client_.prefix().index());
    if (!wished) return wished.error();
    if (Status written = write(wished->end); !written) return written.error();
    return report(*wished);
  }

 private:
  bool continues() const { return !job_.force && bytes_before_ > 0; }

  Status resume() {
    if (!continues()) return {};
    const Result<Bytes> existing = read_file(job_.output);
    if (!existing) return existing.error();
    const Status resumed = client_.resume_from(*existing);
    if (resumed) return {};
    Error error = prefixed(job_.output, resumed.error());
    error.message += " (this file cannot be continued; --force starts over)";
    return error;
  }

  // Writes the sections that the wish needs; a file that is continued keeps all it has.
  Status write(std::uint64_t wish_end) {
    const ByteView held = client_.prefix().verified();
    const std::uint64_t least = continues() ? std::min(bytes_before_, held.size()) : 0;
    written_ = held.first(std::min(std::max(wish_end, least), held.size()));
    if (continues() && written_.size() <= bytes_before_) return {};
    return write_file(job_.output, written_, Overwrite::yes);
  }

  // Writes what had come before `error` if that is more than was there, and says what to do next.
  Error keep_progress(Error error) {
    const ByteView held = client_.prefix().verified();
    const bool is_more = client_.prefix().has_base() && held.size() > bytes_before_;
    if (is_more) {
      if (const Status kept = write_file(job_.output, held, Overwrite::yes); !kept) {
        error.message += "; and the bytes that had come are lost: " + kept.error().message;
        return error;
      }
      error.message +=
          "; " + job_.output + " holds the " + std::to_string(held.size()) + " bytes that had come";
    }
    if (is_more || continues()) error.message += advice();
    return error;
  }

  const char* advice() const {
    switch (client_.remedy()) {
      case Remedy::try_again:
        return job_.force ? "; run again, without --force, to continue" : "; run again to continue";
      case Remedy::start_over:
        return "; --force starts over";
      case Remedy::none:
        break;
    }
    return "";
  }

  FetchReport report(const Resolution& wished) const {
    const FileIndex& index = *client_.prefix().index();
    std::size_t chunks = 0;
    while (chunks < index.chunks.size() && index.prefix_bytes(chunks + 1) <= written_.size()) {
      ++chunks;
    }
    FetchReport report = report_of(client_);
    report.faces = index.faces_after(chunks);
    report.vertices = index.vertices_after(chunks);
    report.reached = wished.reached && written_.size() >= wished.end;
    report.complete = written_.size() == index.header.file_bytes;
    return report;
  }

  StreamingClient& client_;
  const FetchJob& job_;
  std::uint64_t bytes_before_;
  ByteView written_;
};

}  // namespace

Result<FetchReport> fetch_to_file(Transport& transport, const FetchJob& job,
                                  const StreamOptions& options) {
  const bool to_prefix = job.output.ends_with(kMeshFileSuffix);
  if (!to_prefix && !export_format_of(job.output)) {
    return Error{ErrorCode::usage,
                 job.output + ": expected a name in .pmesh, " + std::string(kExportExtensions)};
  }
  if (Status writable = check_writable(job.output); !writable) return writable.error();
  StreamingClient client(transport, options);
  return to_prefix ? PrefixFetch(client, job).run() : fetch_mesh(client, job);
}

}  // namespace pmesh
