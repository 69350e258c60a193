// SHA-256 of a PM file's parts: its identity in URLs, and the check of every section.
// Native only; the decoder itself checks CRC-32C.
#pragma once

#include "core/base/bytes.h"
#include "core/pm/format.h"

namespace pmesh {

/// The content hash of a file whose header and index are `prologue`: SHA-256 over them with the
/// hash field taken as zero. Precondition: prologue holds the hash field.
ContentHash hash_prologue(ByteView prologue);

/// write_prologue() with the content hash brought up to date, in `index`, too.
Bytes write_hashed_prologue(FileIndex& index);

/// The digest of a base mesh's or a chunk's bytes, or of any other.
SectionDigest digest_section(ByteView section);

}  // namespace pmesh
