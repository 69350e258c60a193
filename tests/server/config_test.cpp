#include <gtest/gtest.h>

#include "server/config/live_config.h"
#include "server/config/load_config.h"
#include "tests/fixtures/temporary_directory.h"

namespace pmesh {
namespace {

using Environment = std::map<std::string, std::string>;

/// Sources with a directory to serve, so that they are whole.
ConfigSources sources(std::map<std::string, std::string> flags = {}, Environment variables = {}) {
  flags.try_emplace("directory", "meshes");
  const auto environment = [variables = std::move(variables)](const char* name) {
    const auto found = variables.find(name);
    return found == variables.end() ? nullptr : found->second.c_str();
  };
  return {.file = "", .flags = std::move(flags), .environment = environment};
}

std::string error_of(const ConfigSources& from) {
  const auto config = load_config(from);
  return config ? "no error" : config.error().message;
}

class ConfigFile : public ::testing::Test {
 protected:
  ConfigSources with_file(const std::string& text, ConfigSources others = sources()) {
    others.file = path_;
    put_contents(path_, text);
    return others;
  }

  TemporaryDirectory directory_;
  std::string path_ = directory_ / "pmesh.json";
};

TEST(Config, HasSafeDefaults) {
  const auto config = load_config(sources());
  EXPECT_EQ(config->server.http, "127.0.0.1:8080");
  EXPECT_EQ(config->server.limits.header_bytes, 16 * 1024u);
  EXPECT_EQ(config->log_level, "info");
}

TEST_F(ConfigFile, GoesBeforeDefaults) {
  const auto config = load_config(with_file(R"({"threads": 3, "tcp": "[::1]:9"})"));
  EXPECT_EQ(config->server.threads, 3u);
  EXPECT_EQ(config->server.tcp, "[::1]:9");
}

TEST_F(ConfigFile, GoesBehindTheEnvironmentAndThatBehindFlags) {
  const auto others = sources({{"streams", "7"}}, {{"PMESH_THREADS", "2"}, {"PMESH_STREAMS", "6"}});
  const auto config =
      load_config(with_file(R"({"threads": 1, "streams": 5, "ranges": 4})", others));
  EXPECT_EQ(config->server.threads, 2u);
  EXPECT_EQ(config->server.limits.streams, 7u);
  EXPECT_EQ(config->server.limits.ranges, 4u);
}

TEST(Config, TakesAnEmptyVariableAsNotSet) {
  const auto config = load_config(sources({}, {{"PMESH_THREADS", ""}}));
  ASSERT_TRUE(config);
  EXPECT_EQ(config->server.threads, 0u);
}

TEST(Config, ReadsTimesSizesAndLists) {
  const auto config = load_config(sources({{"idle-timeout", "0.25"},
                                           {"lod-cache-bytes", "2GiB"},
                                           {"queued-bytes", "4096"},
                                           {"access-log", "true"},
                                           {"trusted-proxy", "10.0.0.0/8,fd00::/8"}}));
  EXPECT_EQ(config->server.limits.idle_timeout, std::chrono::milliseconds(250));
  EXPECT_EQ(config->server.lod.cache_bytes, std::size_t{2} << 30);
  EXPECT_EQ(config->server.limits.queued_bytes, 4096u);
  EXPECT_TRUE(config->server.access_log);
  EXPECT_EQ(config->server.trusted_proxies, (std::vector<std::string>{"10.0.0.0/8", "fd00::/8"}));
}

TEST_F(ConfigFile, ReadsTheSameAsJson) {
  const auto config = load_config(with_file(
      R"({"idle-timeout": 0.25, "lod-cache-bytes": "2GiB", "queued-bytes": 4096,
          "access-log": true, "trusted-proxy": ["10.0.0.0/8"]})"));
  EXPECT_EQ(config->server.limits.idle_timeout, std::chrono::milliseconds(250));
  EXPECT_EQ(config->server.lod.cache_bytes, std::size_t{2} << 30);
  EXPECT_EQ(config->server.limits.queued_bytes, 4096u);
  EXPECT_EQ(config->server.trusted_proxies.size(), 1u);
}

TEST(Config, TakesNoneForAnAddress) {
  const auto config = load_config(sources({{"http", "none"}, {"tcp", "127.0.0.1:0"}}));
  EXPECT_EQ(config->server.http, "");
}

TEST(Config, NamesTheFlagThatIsWrong) {
  EXPECT_EQ(error_of(sources({{"threads", "many"}})),
            "--threads: expected a whole number from 0 to 1024, found \"many\"");
  EXPECT_EQ(error_of(sources({{"threads", "1025"}})),
            "--threads: expected a whole number from 0 to 1024, found 1025");
  EXPECT_EQ(error_of(sources({{"idle-timeout", "nan"}})),
            "--idle-timeout: expected seconds from 0.001 to 86400, found null");
}

TEST(Config, NamesTheVariableThatIsWrong) {
  EXPECT_EQ(error_of(sources({}, {{"PMESH_HEADER_BYTES", "1TiB"}})),
            "PMESH_HEADER_BYTES: expected a size such as 65536 or 64KiB, from 1024 to 1048576 "
            "bytes, found \"1TiB\"");
}

TEST_F(ConfigFile, IsNamedWithTheKeyThatIsWrong) {
  EXPECT_EQ(error_of(with_file(R"({"threads": -1})")),
            path_ + ": threads: expected a whole number from 0 to 1024, found -1");
  EXPECT_EQ(error_of(with_file(R"({"threads": "1"})")),
            path_ + ": threads: expected a whole number from 0 to 1024, found \"1\"");
  EXPECT_EQ(error_of(with_file(R"({"thread": 1})")), path_ + ": \"thread\" is no setting");
  EXPECT_EQ(error_of(with_file(R"({"trusted-proxy": [1]})")),
            path_ + ": trusted-proxy: expected a list of texts, found [1]");
}

TEST_F(ConfigFile, IsOneFlatObjectWithoutRepetition) {
  EXPECT_EQ(error_of(with_file(R"({"ranges": 1, "ranges": 1})")),
            path_ + ": \"ranges\" comes twice");
  EXPECT_EQ(error_of(with_file("[1]")), path_ + ": expected a JSON object");
  EXPECT_EQ(error_of(with_file("7")), path_ + ": expected a JSON object");
  EXPECT_EQ(error_of(with_file(R"({"tcp": {}})")),
            path_ + ": \"tcp\": expected a single value or a list of them");
  EXPECT_EQ(error_of(with_file(R"({"tcp": [[]]})")),
            path_ + ": \"tcp\": expected a single value or a list of them");
}

TEST_F(ConfigFile, SaysWhereItsJsonBreaks) {
  EXPECT_TRUE(error_of(with_file("{\n\"tcp\": \n}"))
                  .starts_with(path_ + ": parse error at line 3, column 1"));
  EXPECT_NE(error_of(with_file("")), "no error");
}

TEST_F(ConfigFile, MayNotBeHuge) {
  const std::string padded = "{" + std::string(kMaxConfigBytes, ' ') + "}";
  EXPECT_FALSE(load_config(with_file(padded)));
  EXPECT_FALSE(parse_config(padded));
}

TEST(Config, RefusesAMissingFile) {
  ConfigSources missing = sources();
  missing.file = "/nowhere/pmesh.json";
  EXPECT_EQ(load_config(missing).error().code, ErrorCode::usage);
}

TEST(Config, RefusesWhatDoesNotGoTogether) {
  EXPECT_NE(error_of(sources({{"directory", ""}})), "no error");
  EXPECT_NE(error_of(sources({{"http", "none"}})), "no error");
  EXPECT_NE(error_of(sources({{"tls-key", "key.pem"}})), "no error");
}

TEST(Config, ReadsSecretsFromTheirFiles) {
  const TemporaryDirectory directory;
  put_contents(directory / "tokens", "# ops\n0123456789abcdef\n");
  put_contents(directory / "key", std::string(32, 'k'));
  const auto from =
      sources({{"token-file", directory / "tokens"}, {"url-key-file", directory / "key"}});
  const auto config = load_config(from);
  EXPECT_EQ(config->server.access.tokens, std::vector<std::string>{"0123456789abcdef"});
  EXPECT_EQ(config->server.access.url_key, std::string(32, 'k'));
  EXPECT_EQ(print_config(*config).find("0123456789abcdef"), std::string::npos);
}

TEST_F(ConfigFile, IsWhatPrintConfigPrints) {
  const auto config = load_config(sources({{"idle-timeout", "0.25"},
                                           {"http", "none"},
                                           {"tcp", "127.0.0.1:1"},
                                           {"trusted-proxy", "10.0.0.0/8"},
                                           {"log-format", "json"}}));
  const std::string printed = print_config(*config);
  const auto again = load_config(with_file(printed));
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(print_config(*again), printed);
}

TEST(Settings, HaveDefaultsThatTheyTake) {
  for (const Setting& setting : settings()) {
    ServeConfig config;
    EXPECT_TRUE(setting.set(setting.get(config), config)) << setting.name;
  }
}

/// The row of a setting in docs/operation.md.
std::string manual_row(const Setting& setting) {
  const SettingValue value = setting.get({});
  std::string shown_default = value.is_string() ? value.get<std::string>() : value.dump();
  if (shown_default.empty() || shown_default == "[]") shown_default = "(none)";
  std::string kind = setting.value_name;
  for (std::size_t at = 0; (at = kind.find('|', at)) != std::string::npos; at += 2) {
    kind.replace(at, 1, ", ");
  }
  return "| `" + setting.name + "` | " + kind + " | " + shown_default + " | " +
         (setting.needs_restart ? "restart" : "") + " | " + setting.help + " |\n";
}

TEST(Settings, StandInTheManualInTheirOrder) {
  const std::string manual = contents(PMESH_SOURCE_DIR "/docs/operation.md");
  std::string rows;
  for (const Setting& setting : settings()) rows += manual_row(setting);
  EXPECT_NE(manual.find(rows), std::string::npos) << "expected:\n" << rows;
}

TEST_F(ConfigFile, IsReadAgainWhileTheServerRuns) {
  const auto from = with_file(R"({"streams": 5, "log-level": "warn"})");
  LiveConfig live(from, *load_config(from));
  with_file(R"({"streams": 6, "threads": 9})");
  const auto options = live.reload();
  ASSERT_TRUE(options);
  EXPECT_EQ(options->limits.streams, 6u);
  EXPECT_EQ(options->threads, 0u) << "needs a restart";
}

TEST_F(ConfigFile, KeepsWhatNeedsARestart) {
  ServeConfig reloaded = *load_config(
      sources({{"threads", "9"}, {"tls-key", "k"}, {"tls-certificate", "c"}, {"streams", "3"}}));
  const ServeConfig running = *load_config(sources());
  EXPECT_EQ(keep_until_restart(running, reloaded),
            (std::vector<std::string>{"threads", "tls-certificate", "tls-key"}));
  EXPECT_EQ(reloaded.server.tls.key, "");
  EXPECT_EQ(reloaded.server.limits.streams, 3u);
}

TEST_F(ConfigFile, ThatWentWrongIsAnErrorOfTheReload) {
  const auto from = with_file(R"({"streams": 5})");
  LiveConfig live(from, *load_config(from));
  with_file("{");
  EXPECT_EQ(live.reload().error().code, ErrorCode::usage);
}

}  // namespace
}  // namespace pmesh
