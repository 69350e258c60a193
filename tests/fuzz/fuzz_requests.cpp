// The bytes of an HTTP connection, from its parser to its answers. The first byte seeds the cuts of
// the rest: whole and in pieces must give the same answers, and what is refused ends there.
#include "server/http/request_parser.h"
#include "tests/fuzz/http_checks.h"

namespace {

using namespace pmesh;

const SessionLimits& limits() {
  static const SessionLimits shipped;
  return shipped;
}

/// One connection: what it is fed, and the heads of its answers.
class Connection {
 public:
  void feed(std::string_view bytes) {
    if (ended_) return;
    parser_.feed(bytes);
    while (!ended_ && take_next()) {
    }
  }

  const std::string& answers() const { return answers_; }

 private:
  /// False if no request is whole.
  bool take_next() {
    switch (parser_.next()) {
      case RequestParser::Step::more:
        return false;
      case RequestParser::Step::refusal:
        require(parser_.refusal() >= 400);
        answers_ += head_text(error_answer(parser_.refusal(), "refused"), "today", false);
        ended_ = true;
        return true;
      case RequestParser::Step::request:
        break;
    }
    const HttpAnswer answer = checked_answer(parser_.request());
    answers_ += head_text(answer, "today", parser_.keep_alive());
    ended_ = !parser_.keep_alive() || answer.status == 101;
    return true;
  }

  RequestParser parser_{limits()};
  std::string answers_;
  bool ended_ = false;
};

std::string answers_in_pieces(std::string_view bytes, std::uint32_t seed) {
  Connection connection;
  while (!bytes.empty()) {
    seed = seed * 1664525u + 1013904223u;
    const std::size_t piece = std::min<std::size_t>(bytes.size(), 1 + (seed >> 28));
    connection.feed(bytes.substr(0, piece));
    bytes.remove_prefix(piece);
  }
  return connection.answers();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  Connection whole;
  whole.feed(bytes);
  require(answers_in_pieces(bytes, data[0]) == whole.answers());
  return 0;
}
