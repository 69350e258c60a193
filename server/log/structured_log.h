// What a log line looks like, and how it gets fields. Lines are written by spdlog; each is one line
// whatever is in it, as the names in it may be an attacker's:
//   text  2026-11-23T02:16:43.123Z warn  skipped a.pmesh: no PM file
//   json  {"time":"2026-11-23T02:16:43.123Z","level":"warn","message":"skipped a.pmesh: ..."}
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include <spdlog/common.h>
#include <spdlog/formatter.h>

namespace pmesh {

enum class LogFormat : std::uint8_t {
  text,  ///< For people. Text with other than printable ASCII is escaped as in JSON.
  json,  ///< One JSON object a line, in ASCII.
};

/// A formatter for spdlog::logger::set_formatter. Its loggers must be synchronous: log_event()
/// hands fields over on the calling thread.
std::unique_ptr<spdlog::formatter> make_log_formatter(LogFormat format);

/// The level of that name: debug, info, warn, error or off. Precondition: it is one of these.
spdlog::level::level_enum log_level(std::string_view name);

/// A member of a log line besides time, level and message, which are no names for it.
using LogField =
    std::pair<std::string_view,
              std::variant<bool, std::int64_t, std::uint64_t, double, std::string_view>>;

/// Logs `message` with fields by the default logger: as further members in JSON, as " name=value"
/// behind the message in text. Threads: any.
void log_event(spdlog::level::level_enum level, std::string_view message,
               std::initializer_list<LogField> fields);

}  // namespace pmesh
