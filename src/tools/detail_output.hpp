#pragma once
/// Windows of the surface with its detail (surface_detail.hpp), as rasters.

#include <string>
#include <vector>

#include "src/simulation/simulation.hpp"
#include "src/simulation/views/surface_detail.hpp"

namespace desert_sim {

/// The windows of `--detail X1,Y1,X2,Y2,resolution=R`, in the terrain's frame [m]; lengths are rounded to
/// whole points. Throws ConfigError for another form, a corner off the terrain, a window without an area, a
/// resolution outside [0.001, 1000] m, more than 2²⁶ points, and in a build without GDAL.
std::vector<DetailWindow> detail_windows(const std::vector<std::string>& options, const GridParameters& grid);

/// The elevations of a window of the present state [m].
std::vector<float> detailed_elevations(Simulation& simulation, const DetailWindow& window);

/// Writes folder/detail.tif, detail_2.tif and so on, one for each window.
void write_details(const std::string& folder, Simulation& simulation,
                   const std::vector<DetailWindow>& windows);

}  // namespace desert_sim
