#pragma once
/// Rasters as the patches of brushes.

#include <optional>
#include <string>

#include "src/scenario/raster_grid.hpp"
#include "src/simulation/commands/command.hpp"

namespace desert_sim {

/// The raster at `path`, in its own cells: its values times `scale`, or without one from 0 at its lowest to 1
/// at its highest. Throws ConfigError, in the name of `name` for a raster of too many cells.
command::Patch patch_of_raster(const RasterLoader& load_raster, const std::string& path,
                               const std::string& name, std::optional<double> scale);

}  // namespace desert_sim
