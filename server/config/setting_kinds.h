// The kinds of settings: how texts, numbers, times, sizes and lists are read and checked. For
// settings.cpp alone.
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/parse_number.h"
#include "server/config/setting.h"

namespace pmesh {

/// The part of a config that has members of `Part`.
template <class Part, class Config>
auto& part_of(Config& config) {
  if constexpr (std::is_same_v<Part, ServeConfig>) return config;
  if constexpr (std::is_same_v<Part, ServerOptions>) return config.server;
  if constexpr (std::is_same_v<Part, SessionLimits>) return config.server.limits;
  if constexpr (std::is_same_v<Part, LodLimits>) return config.server.lod;
  if constexpr (std::is_same_v<Part, TlsOptions>) return config.server.tls;
}

inline Error expected(const std::string& what, const SettingValue& found) {
  return {ErrorCode::usage, "expected " + what + ", found " + shown(found)};
}

/// Nothing wrong, or what was expected.
using Check = std::optional<std::string> (*)(const std::string&);

/// Any text that `check` passes.
template <class Part>
Setting text_setting(std::string name, std::string Part::*member, std::string value_name,
                     std::string help, Check check) {
  return {.name = std::move(name),
          .value_name = std::move(value_name),
          .help = std::move(help),
          .from_text = [](std::string_view text) { return SettingValue(text); },
          .set = [=](const SettingValue& value, ServeConfig& config) -> Status {
            if (!value.is_string()) return expected("a text", value);
            const auto text = value.get<std::string>();
            if (const auto wanted = check(text)) return expected(*wanted, value);
            part_of<Part>(config).*member = text;
            return {};
          },
          .get = [=](const ServeConfig& config) { return part_of<Part>(config).*member; }};
}

/// A list of texts that `check` passes one by one; as text, with commas between.
template <class Part>
Setting list_setting(std::string name, std::vector<std::string> Part::*member,
                     std::string value_name, std::string help, Check check) {
  const auto split = [](std::string_view text) {
    SettingValue list = SettingValue::array();
    while (!text.empty()) {
      const std::string_view item = text.substr(0, text.find(','));
      list.push_back(item);
      text.remove_prefix(std::min(text.size(), item.size() + 1));
    }
    return list;
  };
  return {.name = std::move(name),
          .value_name = std::move(value_name),
          .help = std::move(help),
          .from_text = split,
          .set = [=](const SettingValue& value, ServeConfig& config) -> Status {
            if (!value.is_array()) return expected("a list of texts", value);
            std::vector<std::string> list;
            for (const SettingValue& item : value) {
              if (!item.is_string()) return expected("a list of texts", value);
              list.push_back(item.get<std::string>());
              if (const auto wanted = check(list.back())) return expected(*wanted, item);
            }
            part_of<Part>(config).*member = std::move(list);
            return {};
          },
          .get = [=](const ServeConfig& config) { return part_of<Part>(config).*member; }};
}

/// Yes or no.
template <class Part>
Setting flag_setting(std::string name, bool Part::*member, std::string help) {
  return {.name = std::move(name),
          .value_name = "true|false",
          .help = std::move(help),
          .from_text = [](std::string_view text) -> Result<SettingValue> {
            if (text == "true" || text == "false") return SettingValue(text == "true");
            return expected("true or false", text);
          },
          .set = [=](const SettingValue& value, ServeConfig& config) -> Status {
            if (!value.is_boolean()) return expected("true or false", value);
            part_of<Part>(config).*member = value.get<bool>();
            return {};
          },
          .get = [=](const ServeConfig& config) { return part_of<Part>(config).*member; }};
}

struct Range {
  std::uint64_t least;
  std::uint64_t most;
};

/// "a whole number from 1 to 9".
inline std::string range_text(const std::string& what, Range range) {
  return what + " from " + std::to_string(range.least) + " to " + std::to_string(range.most);
}

/// A whole number.
template <class Part, class Number>
Setting count_setting(std::string name, Number Part::*member, Range range, std::string help) {
  const std::string wanted = range_text("a whole number", range);
  return {.name = std::move(name),
          .value_name = "NUMBER",
          .help = std::move(help),
          .from_text = [=](std::string_view text) -> Result<SettingValue> {
            const auto number = parse_whole<std::uint64_t>(text);
            if (!number) return expected(wanted, text);
            return SettingValue(*number);
          },
          .set = [=](const SettingValue& value, ServeConfig& config) -> Status {
            if (!value.is_number_unsigned()) return expected(wanted, value);
            const auto number = value.get<std::uint64_t>();
            if (number < range.least || number > range.most) return expected(wanted, value);
            part_of<Part>(config).*member = static_cast<Number>(number);
            return {};
          },
          .get = [=](const ServeConfig& config) -> SettingValue {
            return static_cast<std::uint64_t>(part_of<Part>(config).*member);
          }};
}

/// "65536", "64KiB", "1MiB" or "2GiB" in bytes.
inline std::optional<std::uint64_t> parse_size(std::string_view text) {
  unsigned shift = 0;
  for (const auto& [unit, bits] :
       {std::pair<std::string_view, unsigned>{"KiB", 10}, {"MiB", 20}, {"GiB", 30}}) {
    if (!text.ends_with(unit)) continue;
    text.remove_suffix(unit.size());
    shift = bits;
    break;
  }
  const auto number = parse_whole<std::uint64_t>(text);
  if (!number || *number > (~std::uint64_t{0} >> shift)) return {};
  return *number << shift;
}

/// Bytes; in JSON a number or a text.
template <class Part, class Number>
Setting size_setting(std::string name, Number Part::*member, Range range, std::string help) {
  const std::string wanted = range_text("a size such as 65536 or 64KiB,", range) + " bytes";
  return {.name = std::move(name),
          .value_name = "SIZE",
          .help = std::move(help),
          .from_text = [](std::string_view text) { return SettingValue(text); },
          .set = [=](const SettingValue& value, ServeConfig& config) -> Status {
            std::optional<std::uint64_t> bytes;
            if (value.is_number_unsigned()) bytes = value.get<std::uint64_t>();
            if (value.is_string()) bytes = parse_size(value.get<std::string>());
            if (!bytes || *bytes < range.least || *bytes > range.most) {
              return expected(wanted, value);
            }
            part_of<Part>(config).*member = static_cast<Number>(*bytes);
            return {};
          },
          .get = [=](const ServeConfig& config) -> SettingValue {
            return static_cast<std::uint64_t>(part_of<Part>(config).*member);
          }};
}

/// Seconds, with decimals, kept to the millisecond; at least one, at most a day.
template <class Part>
Setting seconds_setting(std::string name, std::chrono::milliseconds Part::*member,
                        std::string help) {
  constexpr double kLeast = 0.001, kMost = 86'400;
  const std::string wanted = "seconds from 0.001 to 86400";
  return {.name = std::move(name),
          .value_name = "SECONDS",
          .help = std::move(help),
          .from_text = [=](std::string_view text) -> Result<SettingValue> {
            const auto number = parse_whole<double>(text);
            if (!number) return expected(wanted, text);
            return SettingValue(*number);
          },
          .set = [=](const SettingValue& value, ServeConfig& config) -> Status {
            const double seconds = value.is_number() ? value.get<double>() : -1;
            if (!(seconds >= kLeast && seconds <= kMost)) return expected(wanted, value);
            part_of<Part>(config).*member = std::chrono::milliseconds(std::llround(seconds * 1000));
            return {};
          },
          .get = [=](const ServeConfig& config) -> SettingValue {
            const auto milliseconds = (part_of<Part>(config).*member).count();
            if (milliseconds % 1000 == 0) return milliseconds / 1000;
            return static_cast<double>(milliseconds) / 1000;
          }};
}

}  // namespace pmesh
