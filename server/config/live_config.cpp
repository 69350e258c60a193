#include "server/config/live_config.h"

#include <cassert>

#include <spdlog/spdlog.h>

#include "server/policy.h"

namespace pmesh {

std::vector<std::string> keep_until_restart(const ServeConfig& running, ServeConfig& reloaded) {
  const bool tls_comes_or_goes = running.server.tls.key.empty() != reloaded.server.tls.key.empty();
  std::vector<std::string> changed;
  for (const Setting& setting : settings()) {
    const bool is_fixed =
        setting.needs_restart || (tls_comes_or_goes && setting.name.starts_with("tls-"));
    if (!is_fixed) continue;
    const SettingValue value = setting.get(running);
    if (setting.get(reloaded) == value) continue;
    changed.push_back(setting.name);
    [[maybe_unused]] const Status kept = setting.set(value, reloaded);
    assert(kept);
  }
  return changed;
}

Result<ServerOptions> LiveConfig::reload() {
  auto loaded = load_config(sources_);
  if (!loaded) return loaded.error();
  for (const std::string& name : keep_until_restart(running_, *loaded)) {
    spdlog::warn("reload: {} has changed, which needs a restart", name);
  }
  if (auto policy = make_policy(loaded->server); !policy) return policy.error();
  running_ = std::move(*loaded);
  spdlog::set_level(log_level(running_.log_level));
  return running_.server;
}

}  // namespace pmesh
