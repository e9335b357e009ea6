#pragma once
/// How the numbers of a raster file mean values.

namespace desert_sim {

enum class RasterEncoding : int {
  values,     ///< numbers of one band; pictures of colours are refused
  channel,    ///< numbers of one band, be it a colour of a picture or the index of one
  terrarium,  ///< 256 red + green + blue / 256 - 32768 [m] (Terrain Tiles of Tilezen)
  mapbox      ///< (65536 red + 256 green + blue) / 10 - 10000 [m] (Mapbox Terrain-RGB)
};
constexpr const char* raster_encoding_names[] = {"values", "channel", "terrarium", "mapbox"};

}  // namespace desert_sim
