#pragma once
/// Runs a scenario's terrain steps on the host.

#include <map>
#include <vector>

#include "kernels/field/layers.hpp"
#include "src/scenario/scenario.hpp"

namespace desert_sim {

/// Values in the layers' units, row-major from the south-west. Only layers that a step filled are there;
/// bedrock and sand always are.
using HostLayers = std::map<Layer, std::vector<double>>;

/// `scenario` must be resolved. Throws ConfigError that names step, layer and cell of a value that is not
/// allowed.
HostLayers build_terrain(const Scenario& scenario, const RasterLoader& load_raster);

}  // namespace desert_sim
