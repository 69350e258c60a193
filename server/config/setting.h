// One setting of `pmesh serve`: its name, how its value is spelled as text (flags, environment) and
// in JSON (config file), and where it stands in a ServeConfig. settings() is the table that the
// flags, the environment, the config file, --print-config and the manual go by.
//
// Threads: plain values and pure functions.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base/result.h"
#include "server/config/serve_config.h"

namespace pmesh {

/// A text, a number, yes or no, or a list of texts. Members of objects stay in the order in which
/// they came.
using SettingValue = nlohmann::ordered_json;

struct Setting {
  std::string name;        ///< "header-timeout": the flag without its dashes, and the key in JSON.
  std::string value_name;  ///< "SECONDS", "SIZE", ...: what help shows for the value.
  std::string help;        ///< One sentence, without unit and default.
  bool needs_restart = false;  ///< Reading the configuration again does not change it.

  /// From a flag's or variable's text. Errors (usage) here and in `set` say what was expected and
  /// what was found, not where.
  std::function<Result<SettingValue>(std::string_view)> from_text;
  /// Checks type and range.
  std::function<Status(const SettingValue&, ServeConfig&)> set;
  /// What `set` takes.
  std::function<SettingValue(const ServeConfig&)> get;
};

/// Every setting, in the order in which they are printed.
const std::vector<Setting>& settings();

/// Null if there is no setting of that name.
const Setting* find_setting(std::string_view name);

/// The environment variable of a setting: "PMESH_HEADER_TIMEOUT".
std::string environment_name(std::string_view setting_name);

/// What a message shows of a value: JSON in printable ASCII, cut if it is long.
std::string shown(const SettingValue& value);

}  // namespace pmesh
