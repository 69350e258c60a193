// The files that secrets come from: bearer tokens, and the key that signs URLs. Error messages name
// the file and the line, never what stands there.
//
// Threads: pure functions, but for reading files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace pmesh {

inline constexpr std::size_t kMinTokenBytes = 16;
inline constexpr std::size_t kMinUrlKeyBytes = 32;

/// One token a line: at least kMinTokenBytes of letters, digits and `-._~+/=` (RFC 6750). Blanks
/// around it, empty lines and lines that begin with '#' do not count. Fails (usage) on any other
/// line, and if there is no token at all: an empty list would open the server to everybody.
Result<std::vector<std::string>> parse_tokens(std::string_view text);

/// parse_tokens() of a file of at most 1 MiB.
Result<std::vector<std::string>> read_token_file(const std::string& path);

/// All bytes of a file, a line feed at its end included: at least kMinUrlKeyBytes, at most 64 KiB.
Result<std::string> read_url_key_file(const std::string& path);

}  // namespace pmesh
