// What the fuzz targets of HTTP share: two meshes to ask for, and what every answer must be like.
#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>

#include "server/http/http_answer.h"
#include "tests/fixtures/temporary_directory.h"
#include "tests/server/sample_file.h"

namespace pmesh {

inline void require(bool condition) {
  if (!condition) std::abort();
}

/// A store with the meshes "bunny" and "measured"; seeds know their hashes, always the same.
inline MeshStore& two_meshes() {
  static const TemporaryDirectory directory;
  static const std::string bunny = directory.write("bunny.pmesh", testing::make_sample().bytes);
  static const std::string measured =
      directory.write("measured.pmesh", testing::make_measured_sample().bytes);
  static const std::unique_ptr<MeshStore> opened = MeshStore::open(directory / "").value();
  return *opened;
}

/// The answer to `request`, by a server that is open to all: one with a known status, a whole head,
/// and no byte outside the file.
inline HttpAnswer checked_answer(const HttpRequest& request) {
  static const AccessPolicy access{AccessOptions{}};
  static const SessionLimits limits;
  static CatalogueCache catalogue(two_meshes());
  static const std::function<std::string()> metrics_text = [] { return std::string("none 0\n"); };
  const HttpAnswer answer = answer_http(request, {.store = two_meshes(),
                                                  .catalogue = catalogue,
                                                  .access = access,
                                                  .limits = limits,
                                                  .most_lod_faces = 1000,
                                                  .metrics_text = metrics_text});
  constexpr std::array kStatuses = {101, 200, 204, 206, 304, 400, 404, 405, 414, 416, 426};
  require(std::ranges::count(kStatuses, answer.status) == 1);
  const std::string head = head_text(answer, "today", true);
  require(head.starts_with("HTTP/1.1 ") && head.find("\r\n\r\n") == head.size() - 4);
  require(answer.head_only == (request.method == "HEAD"));
  if (answer.mesh) {
    require(answer.status == 200 || answer.status == 206);
    require(answer.span.begin < answer.span.end && answer.span.end <= answer.mesh->file_bytes());
  }
  if (answer.lod_job) require(answer.status == 200 && answer.lod_job->mesh != nullptr);
  return answer;
}

}  // namespace pmesh
