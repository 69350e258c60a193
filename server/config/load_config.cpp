#include "server/config/load_config.h"

#include <cassert>

#include "core/files/read_file.h"
#include "server/access/credentials.h"

namespace pmesh {
namespace {

Error usage(std::string message) { return {ErrorCode::usage, std::move(message)}; }

Status apply_file(const std::string& path, ServeConfig& config) {
  const Result<Bytes> bytes = read_file(path, kMaxConfigBytes);
  if (!bytes) return usage(bytes.error().message);
  const auto members = parse_config({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
  if (!members) return prefixed(path, members.error());
  return apply_members(*members, path, config);
}

/// Sets one setting from a text that stands at `origin`.
Status apply_text(const Setting& setting, std::string_view text, const std::string& origin,
                  ServeConfig& config) {
  const Result<SettingValue> value = setting.from_text(text);
  if (!value) return prefixed(origin, value.error());
  Status done = setting.set(*value, config);
  return done ? done : prefixed(origin, done.error());
}

Status apply_environment(const ConfigSources& sources, ServeConfig& config) {
  for (const Setting& setting : settings()) {
    const std::string name = environment_name(setting.name);
    const char* text = sources.environment(name.c_str());
    if (text == nullptr || *text == '\0') continue;
    if (Status done = apply_text(setting, text, name, config); !done) return done;
  }
  return {};
}

Status apply_flags(const ConfigSources& sources, ServeConfig& config) {
  for (const auto& [name, text] : sources.flags) {
    const Setting* setting = find_setting(name);
    assert(setting != nullptr);
    if (Status done = apply_text(*setting, text, "--" + name, config); !done) return done;
  }
  return {};
}

Status read_secrets(ServeConfig& config) {
  if (!config.token_file.empty()) {
    auto tokens = read_token_file(config.token_file);
    if (!tokens) return prefixed("token-file", tokens.error());
    config.server.access.tokens = std::move(*tokens);
  }
  if (!config.url_key_file.empty()) {
    auto key = read_url_key_file(config.url_key_file);
    if (!key) return prefixed("url-key-file", key.error());
    config.server.access.url_key = std::move(*key);
  }
  return {};
}

/// What no setting can see alone.
Status check_together(const ServeConfig& config) {
  const ServerOptions& server = config.server;
  if (server.directory.empty()) return usage("there is no directory to serve");
  if (server.http.empty() && server.tcp.empty()) {
    return usage("there is nothing to serve on: neither http nor tcp");
  }
  if (server.tls.certificate.empty() != server.tls.key.empty()) {
    return usage("tls-certificate and tls-key go together");
  }
  return {};
}

}  // namespace

Result<ServeConfig> load_config(const ConfigSources& sources) {
  ServeConfig config;
  if (!sources.file.empty()) {
    if (Status done = apply_file(sources.file, config); !done) return done.error();
  }
  if (Status done = apply_environment(sources, config); !done) return done.error();
  if (Status done = apply_flags(sources, config); !done) return done.error();
  if (Status done = read_secrets(config); !done) return done.error();
  if (Status done = check_together(config); !done) return done.error();
  return config;
}

Status apply_members(const std::vector<NamedValue>& members, const std::string& origin,
                     ServeConfig& config) {
  for (const auto& [name, value] : members) {
    const Setting* setting = find_setting(name);
    if (setting == nullptr) return usage(origin + ": " + shown(name) + " is no setting");
    if (Status done = setting->set(value, config); !done) {
      return prefixed(origin + ": " + name, done.error());
    }
  }
  return {};
}

std::string print_config(const ServeConfig& config) {
  SettingValue object = SettingValue::object();
  for (const Setting& setting : settings()) object[setting.name] = setting.get(config);
  return object.dump(2, ' ', false, SettingValue::error_handler_t::replace);
}

}  // namespace pmesh
