#pragma once
/// Writers of heights and colours as pictures, and of a world for Gazebo. Each file is whole or as it was
/// before.

#include <string>
#include <vector>

#include "src/export/exported_terrain.hpp"

namespace desert_sim {

/// A picture with a pixel for each cell, north up, from colours whose row 0 is the southern one. One with
/// more than 8192 pixels on a side is reduced to as many, which is what graphics cards take.
void write_colours(const std::string& path, int width, int height,
                   const std::vector<render::PackedColour>& colours);

/// The elevation [m] as 32-bit floats, a pixel a cell, north up.
void write_elevation_exr(const std::string& path, const ExportedTerrain& terrain);

/// The elevation as a 16-bit greyscale PNG, a square of 2^n + 1 pixels (square_heights.hpp), north up, from 0
/// at the lowest to 65535 at the highest point. Its description says both, the size of a pixel and where the
/// middle lies. Warns where heights are rounded by more than a centimetre.
void write_height_png(const std::string& path, const ExportedTerrain& terrain);

/// A world for Gazebo 11 (SDF 1.6) whose ground is the terrain, for contact and for cameras. Beside it are
/// the heights as a GeoTIFF of floats, <name>_heights.tif, and the colours as seen from above,
/// <name>_surface.png, both squares of 2^n + 1 points.
void write_gazebo_world(const std::string& path, const ExportedTerrain& terrain);

}  // namespace desert_sim
