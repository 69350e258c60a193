// CRC-32C (Castagnoli, RFC 3720 appendix B.4), the checksum of PM file sections and chunks.
#pragma once

#include <cstdint>

#include "core/base/bytes.h"

namespace pmesh {

/// The CRC-32C of `bytes`; pass an earlier result as `previous` to continue it.
/// crc32c("123456789") is 0xE3069283.
std::uint32_t crc32c(ByteView bytes, std::uint32_t previous = 0);

}  // namespace pmesh
