#pragma once
/// All processes. What includes this calls their steps without compiling them: the two backends do
/// (processes.inc).

#include "desert_sim/config.hpp"
#include "desert_sim/kernels/avalanching_ground.hpp"
#include "desert_sim/kernels/brush_smooth.hpp"
#include "desert_sim/kernels/echo_dunes.hpp"
#include "desert_sim/kernels/held_costs.hpp"
#include "desert_sim/kernels/held_elevation.hpp"
#include "desert_sim/kernels/hydraulic_erosion.hpp"
#include "desert_sim/kernels/layer_values.hpp"
#include "desert_sim/kernels/moisture.hpp"
#include "desert_sim/kernels/plants/cover.hpp"
#include "desert_sim/kernels/plants/illumination.hpp"
#include "desert_sim/kernels/plants/life.hpp"
#include "desert_sim/kernels/plants/marking.hpp"
#include "desert_sim/kernels/rain.hpp"
#include "desert_sim/kernels/reptation.hpp"
#include "desert_sim/kernels/saltation.hpp"
#include "desert_sim/kernels/soil.hpp"
#include "desert_sim/kernels/statistics.hpp"
#include "desert_sim/kernels/surface.hpp"
#include "desert_sim/kernels/traversability.hpp"
#include "desert_sim/kernels/virtual_pipes.hpp"
#include "desert_sim/kernels/water_sources.hpp"
#include "desert_sim/kernels/wind.hpp"
#include "desert_sim/kernels/wind_features.hpp"
#include "desert_sim/kernels/wind_shadow.hpp"

namespace desert_sim {
#define DESERT_STEP extern template
#define E CpuExec
#include "desert_sim/kernels/processes.inc"
#undef E
#if DESERT_WITH_CUDA
#define E CudaExec
#include "desert_sim/kernels/processes.inc"
#undef E
#endif
#undef DESERT_STEP
}  // namespace desert_sim
