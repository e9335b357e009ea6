#pragma once
/// Pictures of a terrain: hillshade coloured by material, and wind.

#include <array>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace desert_sim {

/// Views on host arrays of width * height values, row-major, row 0 = south; null where the layer is not in
/// use. NaN elevation is unknown ground; NaN in another layer counts as 0.
struct PictureInput {
  int width = 0, height = 0;
  double cell_size = 1;                             ///< [m]
  const float* elevation = nullptr;                 ///< solid surface [m], needed
  const float* sand = nullptr;                      ///< [m]
  const float* vegetation = nullptr;                ///< cover [0..1]
  const float* plants = nullptr;                    ///< species that grows there, from 1 on; 0: none
  std::vector<std::array<float, 3>> crown_colours;  ///< by species, red, green, blue [0..1]
  const float* obstacle = nullptr;                  ///< [0/1]
  const float* water = nullptr;                     ///< depth [m]
  const float* soil = nullptr;                      ///< [m]
  const float* wind_shadow = nullptr;               ///< [0..1], drawn as a slight darkening
};

/// Vertical exaggeration that hillshade_picture() shades with: it brings the steepest tenth of what is not
/// flat to a tangent of 0.6; 0.5 to 60, and 1 on flat ground. The picture's caption says it.
double picture_exaggeration(const PictureInput& input);

/// Hillshade (light from the north-west, 40 degrees high), 8UC3 in BGR, north up. Colours: rock grey-brown,
/// soil brown and sand warm yellow (blending in from 2 to 12 cm), vegetation green or in the
/// colours of its species, water blue by depth, obstacles dark violet, unknown ground light grey. A grid
/// below 512 cells on its long side is enlarged by a whole number to 512 or more (smoothly up to 8 times,
/// beyond that cell by cell), one above 2048 reduced to 2048 by area. A caption at the lower left tells
/// extent, relief and exaggeration. Throws ConfigError for an empty grid, a cell_size not > 0, or no
/// elevation.
cv::Mat hillshade_picture(const PictureInput& input);

/// Wind speed as colour, lightly shaded by the elevation (may be null), with arrows to where the air moves,
/// about 32 across, and a caption with the range of speeds. 8UC3 in BGR, north up; sized as
/// hillshade_picture(), but enlarged to 1024 or more so that the arrows have room. wind_x, wind_y: [m/s], row
/// 0 = south. Throws ConfigError as hillshade_picture().
cv::Mat wind_picture(int width, int height, double cell_size, const float* wind_x, const float* wind_y,
                     const float* elevation);

/// Writes a PNG to a temporary name in the same folder and renames it. Throws ConfigError naming the file; a
/// file of that name is then as before.
void write_png(const std::string& path, const cv::Mat& picture);

}  // namespace desert_sim
