// The resident memory of this process, in bytes (Linux).
#pragma once

#include <cstdint>

namespace pmesh::bench {

/// Resident now, after freed memory has been given back to the system.
std::uint64_t resident_bytes();

/// Sets the peak to what is resident now.
void reset_peak();

/// The most that was resident since reset_peak().
std::uint64_t peak_resident_bytes();

}  // namespace pmesh::bench
