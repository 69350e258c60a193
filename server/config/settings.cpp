#include <algorithm>
#include <array>

#include "server/config/setting_kinds.h"
#include "server/net/address_block.h"
#include "server/net/endpoint.h"

namespace pmesh {
namespace {

constexpr std::uint64_t kKiB = 1024, kMiB = kKiB * 1024, kGiB = kMiB * 1024;
constexpr std::size_t kMostShown = 80;

std::optional<std::string> any_text(const std::string&) { return {}; }

std::optional<std::string> address_or_none(const std::string& text) {
  if (text.empty() || text == "none" || parse_endpoint(text)) return {};
  return "ADDRESS:PORT, such as 127.0.0.1:8080, or none";
}

std::optional<std::string> address_block(const std::string& text) {
  if (AddressBlock::parse(text)) return {};
  return "ADDRESS/BITS, such as 10.0.0.0/8";
}

std::optional<std::string> level_name(const std::string& text) {
  constexpr std::array<std::string_view, 5> kNames = {"debug", "info", "warn", "error", "off"};
  if (std::find(kNames.begin(), kNames.end(), text) != kNames.end()) return {};
  return "debug, info, warn, error or off";
}

Setting address_setting(std::string name, std::string ServerOptions::*member, std::string help) {
  Setting setting =
      text_setting(std::move(name), member, "ADDR:PORT", std::move(help), address_or_none);
  setting.set = [member, set = setting.set](const SettingValue& value, ServeConfig& config) {
    Status done = set(value, config);
    if (done && config.server.*member == "none") (config.server.*member).clear();
    return done;
  };
  setting.get = [member](const ServeConfig& config) -> SettingValue {
    return config.server.*member == "" ? "none" : config.server.*member;
  };
  return setting;
}

Setting log_format_setting() {
  return {.name = "log-format",
          .value_name = "text|json",
          .help = "Log lines for people, or one JSON object a line",
          .from_text = [](std::string_view text) { return SettingValue(text); },
          .set = [](const SettingValue& value, ServeConfig& config) -> Status {
            if (value != "text" && value != "json") return expected("text or json", value);
            config.log_format = value == "json" ? LogFormat::json : LogFormat::text;
            return {};
          },
          .get = [](const ServeConfig& config) -> SettingValue {
            return config.log_format == LogFormat::json ? "json" : "text";
          }};
}

std::vector<Setting> process_settings() {
  return {
      text_setting("directory", &ServerOptions::directory, "DIR",
                   "Directory of PM files, searched to any depth", any_text),
      address_setting("http", &ServerOptions::http,
                      "Where to serve HTTP, or none; port 0 is any free one"),
      address_setting("tcp", &ServerOptions::tcp, "Where to serve the frame protocol, or none"),
      address_setting("metrics", &ServerOptions::metrics,
                      "Where to serve /metrics alone; none: with the rest of HTTP"),
      count_setting("threads", &ServerOptions::threads, {0, 1024},
                    "Threads that serve; 0: as many as the machine has cores"),
      count_setting("max-connections", &ServerOptions::max_connections, {1, 10'000'000},
                    "Connections at once, over all protocols"),
      count_setting("max-connections-per-address", &ServerOptions::max_connections_per_address,
                    {0, 10'000'000}, "The same from one IPv4 address or IPv6 /64; 0: any number"),
      list_setting("trusted-proxy", &ServerOptions::trusted_proxies, "CIDR,...",
                   "Proxies whose word on a client's address is believed", address_block),
      seconds_setting("drain-grace", &ServerOptions::drain_grace,
                      "For transfers under way after SIGTERM"),
      count_setting("lod-workers", &LodLimits::workers, {1, 256},
                    "Threads that make finished levels of detail"),
      count_setting("lod-queue", &LodLimits::queue, {0, 100'000},
                    "Levels that wait for a worker; more are answered by 503"),
      count_setting("lod-per-address", &LodLimits::per_address, {0, 100'000},
                    "Levels that wait or are made for one client; 0: any number"),
      count_setting("lod-faces", &LodLimits::faces, {1, 4'000'000'000},
                    "Faces of a finished level; a wish for more is refused"),
      size_setting("lod-cache-bytes", &LodLimits::cache_bytes, {0, 1024 * kGiB},
                   "Finished levels kept in memory"),
      log_format_setting(),
  };
}

std::vector<Setting> live_settings() {
  return {
      size_setting("header-bytes", &SessionLimits::header_bytes, {kKiB, kMiB},
                   "Of an HTTP request: request line and fields"),
      count_setting("header-fields", &SessionLimits::header_fields, {1, 10'000},
                    "Fields of an HTTP request"),
      size_setting("target-bytes", &SessionLimits::target_bytes, {64, kMiB},
                   "Of an HTTP request's target"),
      count_setting("ranges", &SessionLimits::ranges, {1, 1000},
                    "Ranges in one request; more are refused"),
      seconds_setting("header-timeout", &SessionLimits::header_timeout,
                      "For a request's header, a handshake, or the first byte of a connection"),
      seconds_setting("idle-timeout", &SessionLimits::idle_timeout,
                      "Between requests, or between frames while nothing is sent"),
      seconds_setting("send-timeout", &SessionLimits::send_timeout,
                      "Without the peer taking a byte; then the connection is reset"),
      size_setting("send-buffer-bytes", &SessionLimits::send_buffer_bytes, {4 * kKiB, 64 * kMiB},
                   "What the kernel holds for a peer (SO_SNDBUF)"),
      size_setting("live-send-buffer-bytes", &SessionLimits::live_send_buffer_bytes,
                   {4 * kKiB, 64 * kMiB}, "The same for a peer that has just made room by reading"),
      size_setting("queued-bytes", &SessionLimits::queued_bytes, {kKiB, kGiB},
                   "Unsent answers of the frame protocol before the server stops reading"),
      count_setting("streams", &SessionLimits::streams, {1, 65'535},
                    "Meshes open at once on one connection of the frame protocol"),
      text_setting("token-file", &ServeConfig::token_file, "FILE",
                   "Bearer tokens, one a line, that give access to everything", any_text),
      text_setting("url-key-file", &ServeConfig::url_key_file, "FILE",
                   "Key of 32 bytes or more that signs URLs (pmesh sign)", any_text),
      text_setting("tls-certificate", &TlsOptions::certificate, "FILE",
                   "PEM certificate with its chain; with tls-key HTTP is HTTPS", any_text),
      text_setting("tls-key", &TlsOptions::key, "FILE", "PEM key of the certificate", any_text),
      flag_setting("access-log", &ServerOptions::access_log, "A line in the log for every answer"),
      text_setting("log-level", &ServeConfig::log_level, "debug|info|warn|error|off",
                   "The least that is logged", level_name),
  };
}

std::vector<Setting> all_settings() {
  std::vector<Setting> all = process_settings();
  for (Setting& setting : all) setting.needs_restart = true;
  for (Setting& setting : live_settings()) all.push_back(std::move(setting));
  return all;
}

}  // namespace

const std::vector<Setting>& settings() {
  static const std::vector<Setting> all = all_settings();
  return all;
}

const Setting* find_setting(std::string_view name) {
  const auto found = std::find_if(settings().begin(), settings().end(),
                                  [&](const Setting& setting) { return setting.name == name; });
  return found == settings().end() ? nullptr : &*found;
}

std::string environment_name(std::string_view setting_name) {
  std::string name = "PMESH_";
  for (const char c : setting_name) {
    name.push_back(c == '-' ? '_' : static_cast<char>(c - 'a' + 'A'));
  }
  return name;
}

std::string shown(const SettingValue& value) {
  std::string text =
      value.dump(-1, ' ', /*ensure_ascii=*/true, SettingValue::error_handler_t::replace);
  if (text.size() > kMostShown) text.replace(kMostShown, std::string::npos, "...");
  return text;
}

}  // namespace pmesh
