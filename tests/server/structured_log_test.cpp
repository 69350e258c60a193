#include "server/log/structured_log.h"

#include <algorithm>
#include <memory>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

namespace pmesh {
namespace {

/// What is logged in a format while this lives, by the default logger.
class FormattedLog {
 public:
  explicit FormattedLog(LogFormat format) : before_(spdlog::default_logger()) {
    auto logger = std::make_shared<spdlog::logger>(
        "formatted", std::make_shared<spdlog::sinks::ostream_sink_mt>(text_));
    logger->set_formatter(make_log_formatter(format));
    spdlog::set_default_logger(std::move(logger));
  }
  ~FormattedLog() { spdlog::set_default_logger(before_); }
  FormattedLog(const FormattedLog&) = delete;
  FormattedLog& operator=(const FormattedLog&) = delete;

  std::string text() const { return text_.str(); }
  nlohmann::json json() const { return nlohmann::json::parse(text_.str()); }

 private:
  std::shared_ptr<spdlog::logger> before_;
  std::ostringstream text_;
};

/// Every byte, in an order in which most are no UTF-8.
std::string all_bytes() {
  std::string bytes;
  for (int byte = 255; byte >= 0; --byte) bytes.push_back(static_cast<char>(byte));
  return bytes;
}

std::size_t lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

TEST(StructuredLog, BeginsATextLineWithTimeAndLevel) {
  const FormattedLog log(LogFormat::text);
  spdlog::warn("skipped a.pmesh");
  EXPECT_TRUE(log.text().ends_with("Z warn  skipped a.pmesh\n")) << log.text();
  EXPECT_EQ(log.text().find('T'), 10u);
  EXPECT_EQ(log.text().find('Z'), 23u);
}

TEST(StructuredLog, WritesOneJsonObjectALine) {
  const FormattedLog log(LogFormat::json);
  spdlog::error("cannot \"read\"");
  EXPECT_EQ(log.json()["level"], "error");
  EXPECT_EQ(log.json()["message"], "cannot \"read\"");
  EXPECT_EQ(log.json()["time"].get<std::string>().size(), 24u);
  EXPECT_EQ(log.json().size(), 3u);
}

TEST(StructuredLog, AddsFields) {
  const FormattedLog log(LogFormat::json);
  log_event(spdlog::level::info, "request",
            {{"status", std::int64_t{200}}, {"target", "/a\"b"}, {"seconds", 0.5}, {"tls", true}});
  EXPECT_EQ(log.json()["status"], 200);
  EXPECT_EQ(log.json()["target"], "/a\"b");
  EXPECT_EQ(log.json()["seconds"], 0.5);
  EXPECT_EQ(log.json()["tls"], true);
}

TEST(StructuredLog, AddsFieldsToText) {
  const FormattedLog log(LogFormat::text);
  log_event(spdlog::level::info, "request", {{"status", std::int64_t{200}}, {"target", "/a b\n"}});
  EXPECT_TRUE(log.text().ends_with("info  request status=200 target=\"/a b\\n\"\n")) << log.text();
}

TEST(StructuredLog, ForgetsTheFieldsOfTheLineBefore) {
  const FormattedLog log(LogFormat::text);
  log_event(spdlog::level::info, "first", {{"status", std::int64_t{200}}});
  spdlog::info("second");
  EXPECT_TRUE(log.text().ends_with("info  second\n"));
}

TEST(StructuredLog, KeepsWhateverComesOnOneLine) {
  for (const LogFormat format : {LogFormat::text, LogFormat::json}) {
    const FormattedLog log(format);
    log_event(spdlog::level::info, all_bytes(), {{"target", all_bytes()}});
    const std::string text = log.text();
    EXPECT_EQ(lines(text), 1u);
    EXPECT_TRUE(
        std::all_of(text.begin(), text.end() - 1, [](char c) { return c >= ' ' && c <= '~'; }));
  }
}

TEST(StructuredLog, GivesAsciiBackWhateverComesWithIt) {
  const FormattedLog log(LogFormat::json);
  spdlog::info(all_bytes());
  const auto message = log.json()["message"].get<std::string>();
  EXPECT_TRUE(message.ends_with(all_bytes().substr(128)));
}

TEST(StructuredLog, KnowsTheNamesOfLevels) {
  EXPECT_EQ(log_level("debug"), spdlog::level::debug);
  EXPECT_EQ(log_level("error"), spdlog::level::err);
  EXPECT_EQ(log_level("off"), spdlog::level::off);
}

}  // namespace
}  // namespace pmesh
