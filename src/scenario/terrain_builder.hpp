#pragma once
/// Runs a scenario's terrain steps on the host.

#include <map>
#include <string>
#include <vector>

#include "kernels/field/layers.hpp"
#include "src/scenario/raster_grid.hpp"

namespace desert_sim {

/// Values in the layers' units, row-major from the south-west. The map has bedrock, sand, and each layer that
/// a step filled.
using HostLayers = std::map<Layer, std::vector<double>>;

/// Builds the initial terrain. The scenario's grid must have been resolved by resolve_grid(). Throws
/// ConfigError that names step, layer and cell of a value that is not allowed.
HostLayers build_terrain(const Scenario& scenario, const RasterLoader& load_raster);

}  // namespace desert_sim
