// Where a PM file's bits go.
#pragma once

#include <array>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/pm/format.h"
#include "core/pm/split_section.h"

namespace pmesh {

/// What the sections of a PM file take, up to its last whole chunk. Those of splits are what each
/// decision told, -log2 of its chance: with the rest they add up to the file but for the chunks'
/// ends, some bytes each.
struct SectionSizes {
  std::uint64_t header_bytes = 0;
  std::uint64_t index_bytes = 0;
  std::uint64_t base_bytes = 0;
  std::uint64_t component_bytes = 0;  ///< New components at the beginning of chunks.
  std::array<double, kSplitSections> split_bits{};
};

/// Decodes `file`, which may be partial but has its base. Errors as StreamDecoder's.
Result<SectionSizes> measure_sections(ByteView file, const FileIndex& index);

}  // namespace pmesh
