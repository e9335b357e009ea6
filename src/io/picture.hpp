#pragma once
/// Pictures of a terrain: hillshade coloured by material, and wind.

#include <array>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "src/render/palette.hpp"
#include "src/render/rasteriser.hpp"

namespace desert_sim {

/// Pointers to host arrays of width * height values, row-major, row 0 = south; null if a layer is not in use.
/// A NaN elevation means unknown ground; NaN in another layer counts as 0.
struct PictureInput {
  int width = 0, height = 0;
  double cell_size = 1;                             ///< [m]
  const float* elevation = nullptr;                 ///< solid surface [m], required
  const float* sand = nullptr;                      ///< [m]
  const float* vegetation = nullptr;                ///< cover [0..1]
  const float* plants = nullptr;                    ///< number of the species, from 1; 0: none
  std::vector<std::array<float, 3>> crown_colours;  ///< of each species: red, green, blue [0..1]
  render::Palette palette;                          ///< of everything else
  const float* obstacle = nullptr;                  ///< [0/1]
  const float* water = nullptr;                     ///< depth [m]
  const float* soil = nullptr;                      ///< [m]
  const float* wind_shadow = nullptr;               ///< [0..1], drawn as a slight darkening
};

/// Vertical exaggeration of the shading in hillshade_picture(). It scales the 90th percentile of the slopes
/// (flat ground excluded) to a tangent of 0.6, within 0.5 … 60; it is 1 if all ground is flat. The picture's
/// caption states it.
double picture_exaggeration(const PictureInput& input);

/// Hillshade (light from the north-west, 40 degrees high), 8UC3 in BGR, north up. Colours: rock grey-brown,
/// soil brown and sand warm yellow (blended in from 2 to 12 cm depth), vegetation green or in the colours of
/// its species, water blue by depth, obstacles dark violet, unknown ground light grey. A grid of fewer than
/// 512 cells on its long side is enlarged by an integer factor to 512 or more pixels (by cubic interpolation
/// up to a factor of 8, without interpolation beyond); one of more than 2048 cells is reduced to 2048 by area
/// averaging. A caption at the lower left states extent, relief and exaggeration. Throws ConfigError for an
/// empty grid, a cell_size that is not > 0, or a missing elevation.
cv::Mat hillshade_picture(const PictureInput& input);

/// What a picture of vectors shows.
struct VectorCaption {
  const char *name = "wind", *unit = "m/s";
};

/// Wind speed as colour, lightly shaded by the elevation (which may be null), with about 32 arrows along the
/// long side that point to where the air moves, and a caption with the range of speeds. 8UC3 in BGR, north
/// up; sized like hillshade_picture(), but enlarged to 1024 or more pixels so that the arrows have room.
/// wind_x, wind_y: [m/s], row 0 = south; or other vectors, as the caption says. Throws ConfigError like
/// hillshade_picture().
cv::Mat wind_picture(int width, int height, double cell_size, const float* wind_x, const float* wind_y,
                     const float* elevation, const VectorCaption& caption = {});

/// A picture of the renderer, 8UC3 in BGR, without its opacity.
cv::Mat bgr_of(const render::Picture& picture);

/// Writes a PNG file by write_file(). Throws ConfigError that names the file if the path cannot be written
/// or the picture is empty, WriteError if the disk is full or broken; an existing file of that name is then
/// unchanged. `description`: a text that viewers show, in ASCII; empty: none.
void write_png(const std::string& path, const cv::Mat& picture, const std::string& description = "");

}  // namespace desert_sim
