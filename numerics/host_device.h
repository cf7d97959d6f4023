// Marks functions that run on the CPU and on a GPU from one source.
#pragma once

#ifdef __CUDACC__
#define ASTROLITH_HD __host__ __device__
#define ASTROLITH_KERNEL __host__ __device__ __forceinline__
#else
#define ASTROLITH_HD
// For per-point functions so long that the compiler would rather call them: a call keeps a loop scalar.
#define ASTROLITH_KERNEL inline __attribute__((always_inline))
#endif

// A loop marked with ASTROLITH_SIMD_CLONES is compiled for baseline x86-64, AVX2 and AVX-512, and the
// machine chooses at start. All give the same bits: the code says fma where it means it, and nothing else is
// contracted. Sanitizers instrument the resolver before they are ready: one version, as with ASTROLITH_SIMD.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__CUDACC__) && \
    !defined(ASTROLITH_SANITIZED) && !defined(ASTROLITH_ONE_SIMD)
#define ASTROLITH_SIMD_CLONES __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define ASTROLITH_SIMD_CLONES
#endif

// Before a short loop of constant length inside a loop that is to be vectorised: unrolled in time for that.
#if defined(__CUDACC__) || defined(__clang__)
#define ASTROLITH_UNROLL _Pragma("unroll")
#else
#define ASTROLITH_UNROLL _Pragma("GCC unroll 16")
#endif
