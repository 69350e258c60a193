// The text of a config file: one JSON object whose members are settings.
//
// Threads: pure functions.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "server/config/setting.h"

namespace pmesh {

inline constexpr std::size_t kMaxConfigBytes = 1024 * 1024;

using NamedValue = std::pair<std::string, SettingValue>;

/// The object's members in their order. Fails (usage), with the line or the key, on text that is
/// longer than kMaxConfigBytes, on bad JSON, on anything but one object, on a key that comes twice,
/// and on values within values other than lists of single values. Does not know the settings.
Result<std::vector<NamedValue>> parse_config(std::string_view text);

}  // namespace pmesh
