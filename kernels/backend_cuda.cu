/// The processes as CUDA kernels.
#include "kernels/backend/for_each_cuda.cuh"
#include "kernels/processes.hpp"

#define DESERT_STEP template
#define E CudaExec
namespace desert_sim {
#include "kernels/processes.inc"
}
