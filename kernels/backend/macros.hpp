#pragma once
/// DESERT_HD marks what runs on host and device; it is only `inline` where nvcc is not compiling.
/// DESERT_INLINE goes behind a lambda's parameters: the compiler vectorises a loop only if its body is
/// inlined, and large bodies are not unless asked. DESERT_SIMD stands before a loop whose turns do not depend
/// on each other. DESERT_ROLLED stands before one that a GPU is not to unroll. DESERT_RARE marks what is
/// seldom called, so that a GPU does not hold it once for each call.

#if defined(__CUDACC__)
#define DESERT_HD __host__ __device__ __forceinline__
#define DESERT_INLINE
#define DESERT_SIMD
#define DESERT_RARE __host__ __device__ __noinline__
#else
#define DESERT_HD inline __attribute__((always_inline))
#define DESERT_INLINE __attribute__((always_inline))
#define DESERT_SIMD _Pragma("omp simd")
#define DESERT_RARE
#endif

#if defined(__CUDA_ARCH__)
#define DESERT_ROLLED _Pragma("unroll 1")
#else
#define DESERT_ROLLED
#endif
