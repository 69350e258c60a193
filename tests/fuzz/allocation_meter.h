// Counts what the whole program holds by operator new. Linking it replaces operator new and delete.
#pragma once

#include <cstddef>

namespace pmesh {

std::size_t allocated_bytes();

/// The most that were allocated since the last call of restart_peak().
std::size_t peak_bytes();
void restart_peak();

}  // namespace pmesh
