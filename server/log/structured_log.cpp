#include "server/log/structured_log.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <ctime>
#include <iterator>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace pmesh {
namespace {

using Json = nlohmann::ordered_json;
using Fields = std::initializer_list<LogField>;

/// The fields of the line that this thread is logging: spdlog has no way to pass them along.
thread_local const Fields* fields_of_line = nullptr;

std::string dumped(const Json& json) {
  return json.dump(-1, ' ', /*ensure_ascii=*/true, Json::error_handler_t::replace);
}

Json to_json(const LogField& field) {
  return std::visit([](const auto& value) { return Json(value); }, field.second);
}

bool is_printable(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

/// As it is, or escaped if it holds what could end the line or command a terminal.
std::string printable(std::string_view text) {
  if (is_printable(text)) return std::string(text);
  const std::string quoted = dumped(Json(text));
  return quoted.substr(1, quoted.size() - 2);
}

/// RFC 3339, in UTC, with milliseconds.
std::string time_text(spdlog::log_clock::time_point time) {
  const auto since = time.time_since_epoch();
  const std::time_t second = spdlog::log_clock::to_time_t(time);
  const auto millisecond =
      std::chrono::duration_cast<std::chrono::milliseconds>(since).count() % 1000;
  std::tm utc{};
  ::gmtime_r(&second, &utc);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", utc.tm_year + 1900,
                     utc.tm_mon + 1, utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec, millisecond);
}

std::string_view level_name(spdlog::level::level_enum level) {
  switch (level) {
    case spdlog::level::trace:
    case spdlog::level::debug:
      return "debug";
    case spdlog::level::info:
      return "info";
    case spdlog::level::warn:
      return "warn";
    default:
      return "error";
  }
}

std::string_view message_of(const spdlog::details::log_msg& line) {
  return {line.payload.data(), line.payload.size()};
}

std::string text_line(const spdlog::details::log_msg& line) {
  std::string text = fmt::format("{} {:5} {}", time_text(line.time), level_name(line.level),
                                 printable(message_of(line)));
  if (!fields_of_line) return text;
  for (const LogField& field : *fields_of_line) {
    text.append(" ").append(field.first).append("=").append(dumped(to_json(field)));
  }
  return text;
}

std::string json_line(const spdlog::details::log_msg& line) {
  Json json = {{"time", time_text(line.time)},
               {"level", level_name(line.level)},
               {"message", message_of(line)}};
  if (fields_of_line) {
    for (const LogField& field : *fields_of_line) json[std::string(field.first)] = to_json(field);
  }
  return dumped(json);
}

class LineFormatter : public spdlog::formatter {
 public:
  explicit LineFormatter(LogFormat format) : format_(format) {}

  void format(const spdlog::details::log_msg& line, spdlog::memory_buf_t& out) override {
    const std::string text = format_ == LogFormat::json ? json_line(line) : text_line(line);
    out.append(text.data(), text.data() + text.size());
    out.push_back('\n');
  }

  std::unique_ptr<spdlog::formatter> clone() const override {
    return std::make_unique<LineFormatter>(format_);
  }

 private:
  LogFormat format_;
};

}  // namespace

std::unique_ptr<spdlog::formatter> make_log_formatter(LogFormat format) {
  return std::make_unique<LineFormatter>(format);
}

spdlog::level::level_enum log_level(std::string_view name) {
  if (name == "debug") return spdlog::level::debug;
  if (name == "info") return spdlog::level::info;
  if (name == "warn") return spdlog::level::warn;
  if (name == "error") return spdlog::level::err;
  assert(name == "off");
  return spdlog::level::off;
}

void log_event(spdlog::level::level_enum level, std::string_view message,
               std::initializer_list<LogField> fields) {
  fields_of_line = &fields;
  spdlog::default_logger_raw()->log(level, "{}", message);
  fields_of_line = nullptr;
}

}  // namespace pmesh
