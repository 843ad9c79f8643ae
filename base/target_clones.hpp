#pragma once

// Hot kernels that pass no Eigen types are compiled for AVX2 and for the baseline; the version to
// run is chosen when the program starts.
#if defined(__x86_64__)
#define ROADBOOK_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define ROADBOOK_CLONES
#endif
