#include "src/io/projection.hpp"

#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "src/io/gdal_messages.hpp"
#include "src/io/raster_geometry.hpp"

namespace desert_sim {

namespace {

/// EPSG code of WGS 84 / UTM, or of WGS 84 / UPS beyond the latitudes that UTM covers.
int metric_epsg(double longitude, double latitude) {
  if (latitude > 84) return 32661;
  if (latitude < -80) return 32761;
  const double turns = std::floor((longitude + 180) / 360);
  const int zone = std::clamp(static_cast<int>((longitude + 180 - 360 * turns) / 6) + 1, 1, 60);
  return (latitude < 0 ? 32700 : 32600) + zone;
}

/// The text as one word of a POSIX shell.
std::string shell_word(const std::string& text) {
  const bool plain = std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) || std::string("/._-+,=@%").find(static_cast<char>(c)) != std::string::npos;
  });
  if (plain && !text.empty() && text[0] != '-') return text;
  std::string word = text[0] == '-' ? "'./" : "'";
  for (char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
  return word + "'";
}

/// Turns a point of the projection into longitude and latitude [deg]; false if they cannot be known.
bool to_degrees(const OGRSpatialReference& crs, double& x, double& y) {
  OGRSpatialReference geographic;
  geographic.CopyGeogCSFrom(&crs);
  geographic.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  OGRSpatialReference projected(crs);
  projected.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> transformation(
      OGRCreateCoordinateTransformation(&projected, &geographic));
  return transformation && transformation->Transform(1, &x, &y) && std::isfinite(x) && std::isfinite(y);
}

}  // namespace

std::string projecting_command(const std::string& path, double longitude, double latitude) {
  const std::string code = std::to_string(metric_epsg(longitude, latitude));
  const std::filesystem::path file(path);
  const std::string projected = (file.parent_path() / (file.stem().string() + "_" + code + ".tif")).string();
  return "gdalwarp -t_srs EPSG:" + code + " -r bilinear " + shell_word(path) + " " + shell_word(projected);
}

void require_metres(const std::string& path, const std::string& wkt, double x, double y) {
  if (wkt.empty()) return;
  const GdalMessages quiet;
  OGRSpatialReference crs;
  if (crs.importFromWkt(wkt.c_str()) != OGRERR_NONE) return;
  std::string unit = "degrees";
  bool located = true;
  if (!crs.IsGeographic()) {
    const char* name = nullptr;
    if (std::abs(crs.GetLinearUnits(&name) - 1) < 1e-9) return;
    unit = name ? std::string("the unit ") + name : "another unit";
    located = to_degrees(crs, x, y);
  }
  throw_raster_error(path, "its coordinates are in " + unit + ", metres are needed; project it first" +
                               (located ? ": " + projecting_command(path, x, y)
                                        : " with gdalwarp -t_srs to a projection in metres"));
}

}  // namespace desert_sim
