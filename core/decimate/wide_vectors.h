// A second version of a function for processors with vectors of four doubles, chosen when the
// program starts. It gives the same bits: there is no fused multiply-add in it.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PMESH_WIDE_VECTORS __attribute__((target_clones("avx2", "default")))
#else
#define PMESH_WIDE_VECTORS
#endif
