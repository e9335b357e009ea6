#pragma once
/// Windows of the surface with its micro-relief (micro_relief.hpp), as rasters.

#include <string>
#include <vector>

#include "src/simulation/simulation.hpp"
#include "src/simulation/views/micro_relief.hpp"

namespace desert_sim {

/// The windows of `--micro-relief X1,Y1,X2,Y2,resolution=R`, in the terrain's frame [m]; lengths are
/// rounded to whole points. Throws ConfigError for another form, a corner off the terrain, a window without
/// an area, a resolution outside [0.001, 1000] m, more than 2²⁶ points, and in a build without GDAL.
std::vector<MicroReliefWindow> micro_relief_windows(const std::vector<std::string>& options,
                                                    const GridParameters& grid);

/// The elevations of a window of the present state [m].
std::vector<float> rippled_elevations(Simulation& simulation, const MicroReliefWindow& window);

/// Writes folder/micro_relief.tif, micro_relief_2.tif and so on, one for each window.
void write_micro_relief(const std::string& folder, Simulation& simulation,
                        const std::vector<MicroReliefWindow>& windows);

}  // namespace desert_sim
