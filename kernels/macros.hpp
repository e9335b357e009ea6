#pragma once
/// DESERT_HD marks what runs on host and device; it is only `inline` where nvcc is not compiling.

#if defined(__CUDACC__)
#define DESERT_HD __host__ __device__ __forceinline__
#else
#define DESERT_HD inline __attribute__((always_inline))
#endif
