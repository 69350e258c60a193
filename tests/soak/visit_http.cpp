#include <array>
#include <deque>
#include <optional>

#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>

#include "protocol/routes.h"
#include "tests/soak/visit.h"

namespace pmesh::soak {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using asio::use_awaitable;

namespace {

constexpr std::uint64_t kMostRequests = 20;
constexpr std::uint64_t kMostPipelined = 4;

struct Question {
  std::string target{};
  std::string method = "GET";
  std::string fields{};
  unsigned status = 200;
  std::optional<std::string_view> body{};  // if it is known before
  bool is_level = false;
};

Question about_the_file(Visitor& visitor, const SoakMesh& mesh) {
  const LodRequest wish = random_wish(visitor.random, mesh.index);
  const Resolution level = *resolve(wish, mesh.index);
  Question question{.target = file_target(mesh.id, mesh.index.header.content_hash, wish)};
  std::uint64_t begin = level.begin;
  std::uint64_t end = level.end;
  if (once_in(visitor.random, 2)) {
    const std::uint64_t size = end - begin;
    const std::uint64_t first = below(visitor.random, size);
    const std::uint64_t last = first + below(visitor.random, size - first);
    question.fields = "Range: bytes=" + std::to_string(first) + "-" + std::to_string(last) + "\r\n";
    question.status = 206;
    end = begin + last + 1;
    begin += first;
  }
  question.body = mesh.text(begin, end);
  return question;
}

Question about_a_chunk(Visitor& visitor, const SoakMesh& mesh) {
  if (mesh.index.chunks.empty()) return {.target = "/" + mesh.id};
  const std::uint64_t chunk = below(visitor.random, mesh.index.chunks.size());
  const ChunkRow& row = mesh.index.chunks[static_cast<std::size_t>(chunk)];
  return {.target = chunk_target(mesh.id, mesh.index.header.content_hash, chunk),
          .body = mesh.text(row.offset, row.end())};
}

Question about_a_level(Visitor& visitor, const SoakMesh& mesh) {
  constexpr std::array kFormats = {"glb", "ply", "obj", "drc"};
  if (!mesh.decodes) return {.target = "/" + mesh.id};
  const std::uint64_t faces = 1 + below(visitor.random, 4) * (mesh.index.header.faces + 3) / 3;
  return {.target = "/" + mesh.id + "/lod." + kFormats[below(visitor.random, kFormats.size())] +
                    "?faces=" + std::to_string(faces),
          .is_level = true};
}

Question any_question(Visitor& visitor) {
  const SoakMesh& mesh = visitor.any_mesh();
  switch (below(visitor.random, 12)) {
    case 0:
      return {.target = "/catalog"};
    case 1:
      return {.target = "/" + mesh.id};
    case 2:
      return {.target = "/health", .body = R"({"status":"ok"})"};
    case 3:
      return {.target = "/nobody", .status = 404};
    case 4:
      return {.target = "/" + mesh.id, .method = "HEAD", .body = ""};
    case 5:
      return about_a_level(visitor, mesh);
    case 6:
    case 7:
      return about_a_chunk(visitor, mesh);
    default:
      return about_the_file(visitor, mesh);
  }
}

std::string text_of(const Question& question) {
  return question.method + " " + question.target + " HTTP/1.1\r\nHost: soak\r\n" + question.fields +
         "\r\n";
}

void check(Visitor& visitor, const Question& question, unsigned status, const std::string& body) {
  Tally& tally = visitor.tally;
  ++tally.answers;
  tally.bytes += body.size();
  if (question.is_level && status == 503) {
    ++tally.busy;
    return;
  }
  if (status != question.status) {
    return visitor.fault(question.target + ": " + std::to_string(status));
  }
  if (question.body && body != *question.body) visitor.fault(question.target + ": wrong bytes");
  if (question.is_level &&
      visitor.levels.try_emplace(question.target, body).first->second != body) {
    visitor.fault(question.target + ": another body than before");
  }
}

asio::awaitable<void> read_answer(Visitor& visitor, Socket& socket,
                                  boost::beast::flat_buffer& buffer, const Question& question) {
  http::response_parser<http::string_body> parser;
  parser.body_limit(boost::none);
  parser.skip(question.method == "HEAD");
  co_await http::async_read(socket, buffer, parser, use_awaitable);
  check(visitor, question, parser.get().result_int(), parser.get().body());
}

asio::awaitable<void> read_a_little(Visitor& visitor, Socket& socket) {
  std::string some(below(visitor.random, 100'000) + 1, '\0');
  co_await socket.async_read_some(asio::buffer(some), use_awaitable);
}

}  // namespace

asio::awaitable<void> visit_http(Visitor& visitor) {
  Socket socket = co_await connect(visitor, visitor.http_port);
  boost::beast::flat_buffer buffer;
  for (std::uint64_t left = 1 + below(visitor.random, kMostRequests); left > 0; --left) {
    std::deque<Question> questions(1 + below(visitor.random, kMostPipelined));
    std::string text;
    for (Question& question : questions) {
      question = any_question(visitor);
      text += text_of(question);
    }
    const bool leaves_asking = once_in(visitor.random, 60);
    const bool leaves_reading = once_in(visitor.random, 30);
    if (leaves_asking) text.resize(below(visitor.random, text.size()));
    co_await asio::async_write(socket, asio::buffer(text), use_awaitable);
    if (leaves_reading && !leaves_asking) co_await read_a_little(visitor, socket);
    if (leaves_asking || leaves_reading) co_return abort(visitor, socket);
    for (const Question& question : questions) {
      co_await read_answer(visitor, socket, buffer, question);
    }
  }
}

}  // namespace pmesh::soak
