#pragma once
/// Includes the parallel loops (for_each.hpp) of the backend that a source is compiled for. CMake compiles
/// each kernels/<folder>/<name>.cpp twice, as C++ and as CUDA, except those named *_cpu.cpp and *_host.cpp.

#if defined(__CUDACC__)
#include "kernels/backend/for_each_cuda.cuh"
namespace desert_sim {
using Backend = CudaExec;
}
#else
#include "kernels/backend/for_each_cpu.hpp"
namespace desert_sim {
using Backend = CpuExec;
}
#endif
