#pragma once
/// Macros for code that is compiled for the CPU and for the GPU.
///
///   DESERT_HD       before a function: for host and device; only inline where nvcc is not compiling
///   DESERT_INLINE   behind a lambda's parameters: always inlined. Compilers vectorise a loop only if its
///                   body is inlined, and do not inline large bodies by themselves.
///   DESERT_MAY_ALIAS   behind a type: values of it may be changed by what is written as any other type
///   DESERT_SIMD     before a loop whose iterations do not depend on each other
///   DESERT_NO_UNROLL   before a loop that must not be unrolled on a GPU
///   DESERT_NOINLINE     before a function that is seldom called: not inlined on a GPU, for small kernels

#if defined(__CUDACC__)
#define DESERT_HD __host__ __device__ __forceinline__
#define DESERT_INLINE
#define DESERT_MAY_ALIAS
#define DESERT_SIMD
#define DESERT_NOINLINE __host__ __device__ __noinline__
#else
#define DESERT_HD inline __attribute__((always_inline))
#define DESERT_INLINE __attribute__((always_inline))
#define DESERT_MAY_ALIAS __attribute__((may_alias))
#define DESERT_SIMD _Pragma("omp simd")
#define DESERT_NOINLINE
#endif

#if defined(__CUDA_ARCH__)
#define DESERT_NO_UNROLL _Pragma("unroll 1")
#else
#define DESERT_NO_UNROLL
#endif
