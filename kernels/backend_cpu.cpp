/// The processes as OpenMP loops.
#include "desert_sim/kernels/for_each_cpu.hpp"
#include "desert_sim/kernels/processes.hpp"

#define DESERT_STEP template
#define E CpuExec
namespace desert_sim {
#include "desert_sim/kernels/processes.inc"
}
