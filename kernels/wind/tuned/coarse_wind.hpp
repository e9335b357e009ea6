#pragma once
/// GPU forms of the coarse wind's passes, with results bit-identical to the generic ones in wind.cpp.

#include "kernels/wind/wind_laws.hpp"

#if DESERT_WITH_CUDA
namespace desert_sim::wind {

/// All passes of transform_pass_by_pass() in one kernel; see coarse_wind.cu.
void transform_in_one_kernel(CudaExec& exec, const CoarseLaws& laws, Workspace& work);
/// Row means by way of shared memory; see coarsen_rows.cu.
void coarsen_rows(CudaExec& exec, const CoarsenRows& law);

}  // namespace desert_sim::wind
#endif
