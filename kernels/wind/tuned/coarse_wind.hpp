#pragma once
/// Forms of the coarse wind's passes for the GPU alone, with the bits of the general ones in wind.cpp.

#include "kernels/wind/wind_laws.hpp"

#if DESERT_WITH_CUDA
namespace desert_sim::wind {

/// All that transform_by_library() does, in one kernel; coarse_wind.cu.
void transform_by_lines(CudaExec& exec, const CoarseLaws& laws, Workspace& work);
/// The rows' means by way of shared memory; coarsen_rows.cu.
void coarsen_rows(CudaExec& exec, const CoarsenRows& law);

}  // namespace desert_sim::wind
#endif
