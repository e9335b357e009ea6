#pragma once
/// Passes over all tiles on a GPU with the same results as RelaxTile to the bit; implemented in tile.cu.

#include "kernels/avalanching/tile.hpp"

#if DESERT_WITH_CUDA
namespace desert_sim::avalanching {

void relax_tiles_tuned(CudaExec& exec, const RelaxTile& law, const NoFollowUp& then);
void relax_tiles_tuned(CudaExec& exec, const RelaxTile& law, const Restrict& then);
void relax_tiles_tuned(CudaExec& exec, const RelaxTile& law, const surface::ComputeBlockHeights& then);

}  // namespace desert_sim::avalanching
#endif
