// Marks functions that run on the CPU and on a GPU from one source.
#pragma once

#ifdef __CUDACC__
#define ASTROLITH_HD __host__ __device__
#define ASTROLITH_KERNEL __host__ __device__ __forceinline__
#else
#define ASTROLITH_HD
// Long per-point functions are marked with ASTROLITH_KERNEL. The compiler would not inline them by itself,
// and a call inside a loop would keep the loop from being vectorised.
#define ASTROLITH_KERNEL inline __attribute__((always_inline))
#endif

// A function marked with ASTROLITH_SIMD_CLONES is compiled for baseline x86-64, AVX2 and AVX-512, and the
// machine chooses one when the program starts. All versions give the same bits: the code writes fma where it
// means it, and the compiler contracts nothing else. Sanitizers instrument the function that chooses before
// they are ready, so sanitized builds have one version. ASTROLITH_SIMD builds have one version too.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__CUDACC__) && \
    !defined(ASTROLITH_SANITIZED) && !defined(ASTROLITH_ONE_SIMD)
#define ASTROLITH_SIMD_CLONES __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define ASTROLITH_SIMD_CLONES
#endif

// Stands before a short loop of constant length inside a loop that is to be vectorised. The short loop is
// then unrolled early enough for the outer one to be vectorised.
#if defined(__CUDACC__) || defined(__clang__)
#define ASTROLITH_UNROLL _Pragma("unroll")
#else
#define ASTROLITH_UNROLL _Pragma("GCC unroll 16")
#endif
