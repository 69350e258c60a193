// Answers to requests for two made-up files, without sockets.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "tests/server/http_site.h"
#include "tests/server/sample_file.h"

namespace pmesh::testing {

class HttpAnswerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    directory_.write("bunny.pmesh", bunny_.bytes);
    directory_.write("measured.pmesh", measured_.bytes);
  }

  HttpAnswer get(const std::string& target, HttpRequest request = {}) {
    target_ = target;
    request.target = target_;
    if (request.method.empty()) request.method = "GET";
    return answer_http(request, site_.context());
  }

  std::string file(const std::string& query = "") const {
    return "/bunny/" + bunny_.hash() + ".pmesh" + query;
  }
  std::string measured_file(const std::string& query) const {
    return "/measured/" + measured_.hash() + ".pmesh" + query;
  }
  std::string etag(const std::string& suffix = "") const {
    return std::string("\"").append(bunny_.hash()).append(suffix).append("\"");
  }
  std::uint64_t chunk_end(std::size_t chunk) const { return bunny_.index.chunks[chunk].end(); }

  const SampleFile bunny_ = make_sample();
  const SampleFile measured_ = make_measured_sample();
  const std::uint64_t size_ = bunny_.bytes.size();
  testing::HttpSite site_;
  const TemporaryDirectory& directory_ = site_.directory();
  std::string target_;
};

}  // namespace pmesh::testing
