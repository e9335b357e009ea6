#pragma once
/// What the source of a process includes: the loops (for_each.hpp) of the backend that it is compiled for. CMake
/// compiles each kernels/<room>/<name>.cpp twice, as C++ and as CUDA, but for those named *_cpu.cpp and *_host.cpp.

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
