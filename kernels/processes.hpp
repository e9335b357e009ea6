#pragma once
/// All processes. What includes this calls their steps without compiling them: the two backends do
/// (processes.inc).

#include "desert_sim/config.hpp"
#include "kernels/avalanching/soil_and_bedrock.hpp"
#include "kernels/edit/brush_smooth.hpp"
#include "kernels/field/statistics.hpp"
#include "kernels/field/surface.hpp"
#include "kernels/plants/cover.hpp"
#include "kernels/plants/illumination.hpp"
#include "kernels/plants/life.hpp"
#include "kernels/plants/marking.hpp"
#include "kernels/rover/traversability.hpp"
#include "kernels/sand/reptation.hpp"
#include "kernels/sand/saltation.hpp"
#include "kernels/soil/moisture.hpp"
#include "kernels/soil/soil.hpp"
#include "kernels/view/held_costs.hpp"
#include "kernels/view/held_elevation.hpp"
#include "kernels/view/layer_values.hpp"
#include "kernels/water/hydraulic_erosion.hpp"
#include "kernels/water/rain.hpp"
#include "kernels/water/virtual_pipes.hpp"
#include "kernels/water/water_sources.hpp"
#include "kernels/wind/echo_dunes.hpp"
#include "kernels/wind/wind.hpp"
#include "kernels/wind/wind_features.hpp"
#include "kernels/wind/wind_shadow.hpp"

namespace desert_sim {
#define DESERT_STEP extern template
#define E CpuExec
#include "kernels/processes.inc"
#undef E
#if DESERT_WITH_CUDA
#define E CudaExec
#include "kernels/processes.inc"
#undef E
#endif
#undef DESERT_STEP
}  // namespace desert_sim
