#pragma once
/// The light on the ground: of the sun, whom hills and dunes can hide, and of the sky. The same in rviz and
/// in films.

#include "src/render/cells.hpp"
#include "src/render/colour.hpp"
#include "src/render/view.hpp"

namespace desert_sim::render {

/// The unit vector towards the sun. It stands low in the west-north-west (36 degrees high), so that slip
/// faces under a west wind are in shade.
const Point& towards_sun();

/// The factors by which light brightens or darkens the channels of a surface with this upward unit normal:
/// 1 on level ground in the sun. Sunlight is warm, that of the sky, which alone reaches shade, is blue.
/// `sun`: the share of the sun that hills do not hide, 0…1 (sun_visibility()).
Colour illumination(float normal_x, float normal_y, float normal_z, float sun = 1);
/// A colour in light of these factors.
Colour lit(const Colour& colour, const Colour& light);

/// Over how many cells hills of this relief [m] can cast a shadow; at most `longest_shadow`.
int shadow_reach(double relief, double cell_size);
constexpr int longest_shadow = 256;  ///< [cells]; longer ones end there
/// The cells whose heights decide how much of the sun reaches any of `cells`, and those that any of `cells`
/// can shade. `reach`: that of shadow_reach().
CellRectangle cells_that_shade(const CellRectangle& cells, int reach);
CellRectangle cells_in_shade_of(const CellRectangle& cells, int reach);

/// The share of the sun that reaches each of `cells`, 0…1, with edges of shadows one cell wide. `surface`
/// has the heights [m] of cells_that_shade(cells, reach) as far as the grid goes; unknown ones cast no
/// shadow. Heights are multiplied by `exaggeration`. In time of the number of cells: each one passes on how
/// high the shadow above it is.
CellWindow sun_visibility(const CellRectangle& cells, const CellWindow& surface, double cell_size,
                          float exaggeration);

}  // namespace desert_sim::render
