/// The processes as OpenMP loops.
#include "kernels/backend/for_each_cpu.hpp"
#include "kernels/processes.hpp"

#define DESERT_STEP template
#define E CpuExec
namespace desert_sim {
#include "kernels/processes.inc"
}
