#pragma once
/// Coordinates that are not metres on the ground, and how to project them.

#include <string>

class OGRSpatialReference;

namespace desert_sim {

struct DeclaredBand;  // raster.hpp

/// Where the cells of a raster lie in the coordinates of its projection.
struct RasterExtent {
  double west, south, cell_x, cell_y;
  int width, height;
  double east() const { return west + width * cell_x; }
  double north() const { return south + height * cell_y; }
};

/// How "project it first" goes on: ": gdalwarp …", the command that projects a raster to metres on the ground
/// around a place (x, y) in the coordinates of `crs`: on Earth to the UTM zone, near the poles to the polar
/// stereographic projection; on another body to a transverse Mercator or polar stereographic projection of
/// its own. What is not covered has no data. Heights in a unit that their band declares are left in it,
/// because gdalwarp would make them metres and keep the unit; colours, which encode heights, are not mixed.
/// With an `extent` cells are square and as large as the raster's, and lie within it where most of it is then
/// kept.
std::string how_to_project(const std::string& path, const OGRSpatialReference& crs, double x, double y,
                           const DeclaredBand& band, const RasterExtent* extent = nullptr);

/// The unit of the projection's heights where its vertical system declares one that is not the metre, such as
/// "US survey foot"; else empty.
std::string unit_of_heights(const std::string& wkt);
/// Throws ConfigError where the projection's vertical system points down, so that values are depths, unless
/// the step's scale is negative.
void require_heights(const std::string& path, const std::string& wkt, double scale);
/// The projection of values that have been made metres: without a vertical system of another unit or
/// direction, by which readers would make them metres or heights once more.
std::string with_metric_heights(const std::string& wkt);

/// Throws ConfigError that has this command where the coordinates are known not to be metres on the ground:
/// for degrees and other units, and where the projection's scale at the raster's centre differs from 1 by
/// more than 1 %, as Web Mercator's does away from the equator (k = 1 / cos of the latitude).
void require_metres(const std::string& path, const std::string& wkt, const RasterExtent& extent,
                    const DeclaredBand& band);

/// Throws ConfigError in the name of `source` that names the folders in which PROJ looked if it has no
/// database that it can use, without which projections by their codes cannot be understood or written.
void require_projection_database(const std::string& source);

}  // namespace desert_sim
