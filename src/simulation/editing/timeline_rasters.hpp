#pragma once
/// Rasters that commands of run.timeline name.
///
///     {time: 600, command: edit_terrain, shape: patch, image_file: dunes.tif, image_scale: 0.5, x: 40,
///      y: 50, radius: 20, radius_y: 15}
///
/// The keys are those of ~edit_terrain: heights are multiplied by `image_scale` (1 if it is not given), and
/// a mask (`patch_use: mask`) is 0 at its lowest and 1 at its highest value. `image_file` is looked for as
/// other rasters of the scenario are.

#include "src/scenario/raster_grid.hpp"

namespace desert_sim {

/// Puts the values of the rasters into the commands in the place of their names, so that a saved scenario, a
/// checkpoint and a journal need no file. Throws ConfigError that lists all which cannot be read, or which
/// have more than command::Patch::max_pixels cells together.
void read_timeline_rasters(Scenario& scenario, const RasterLoader& load_raster);

}  // namespace desert_sim
