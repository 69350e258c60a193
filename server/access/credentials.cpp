#include "server/access/credentials.h"

#include <algorithm>

#include "core/base/trimmed.h"
#include "core/files/read_file.h"

namespace pmesh {
namespace {

constexpr std::uint64_t kMaxTokenFileBytes = 1024 * 1024;
constexpr std::uint64_t kMaxUrlKeyBytes = 64 * 1024;

bool is_token_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("-._~+/=").find(c) != std::string_view::npos;
}

bool is_token(std::string_view text) {
  return text.size() >= kMinTokenBytes && std::all_of(text.begin(), text.end(), is_token_character);
}

/// A setting that names a file without sense is a usage error, whatever is wrong with it.
Result<std::string> read_text(const std::string& path, std::uint64_t max_bytes) {
  const Result<Bytes> bytes = read_file(path, max_bytes);
  if (!bytes) return Error{ErrorCode::usage, bytes.error().message};
  return std::string(bytes->begin(), bytes->end());
}

}  // namespace

Result<std::vector<std::string>> parse_tokens(std::string_view text) {
  std::vector<std::string> tokens;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    const std::string_view token = trimmed(line);
    if (token.empty() || token.starts_with('#')) continue;
    if (!is_token(token)) {
      return Error{ErrorCode::usage, "line " + std::to_string(number) +
                                         ": expected a token of 16 or more letters, digits and "
                                         "-._~+/="};
    }
    tokens.emplace_back(token);
  }
  if (tokens.empty()) return Error{ErrorCode::usage, "there is no token in it"};
  return tokens;
}

Result<std::vector<std::string>> read_token_file(const std::string& path) {
  const auto text = read_text(path, kMaxTokenFileBytes);
  if (!text) return text.error();
  auto tokens = parse_tokens(*text);
  if (!tokens) return prefixed(path, tokens.error());
  return tokens;
}

Result<std::string> read_url_key_file(const std::string& path) {
  auto key = read_text(path, kMaxUrlKeyBytes);
  if (key && key->size() < kMinUrlKeyBytes) {
    return Error{ErrorCode::usage,
                 path + ": a key has at least 32 bytes, this one " + std::to_string(key->size())};
  }
  return key;
}

}  // namespace pmesh
