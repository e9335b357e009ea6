/// The processes as CUDA kernels.
#include "desert_sim/kernels/for_each_cuda.cuh"
#include "desert_sim/kernels/processes.hpp"

#define DESERT_STEP template
#define E CudaExec
namespace desert_sim {
#include "desert_sim/kernels/processes.inc"
}
