#include "src/io/projection.hpp"

#include <cpl_string.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>

#include "src/core/constants.hpp"
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
    return std::isalnum(c) || std::string("/._-+,=@%:").find(static_cast<char>(c)) != std::string::npos;
  });
  if (plain && !text.empty() && text[0] != '-') return text;
  std::string word = text[0] == '-' ? "'./" : "'";
  for (char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
  return word + "'";
}

std::string wkt_of(const OGRSpatialReference& crs) {
  char* text = nullptr;
  const bool known = crs.exportToWkt(&text) == OGRERR_NONE && text;
  const std::string wkt = known ? text : "";
  CPLFree(text);
  return wkt;
}

struct Ellipsoid {
  double a, b;  ///< semi-axes [m]
};

Ellipsoid ellipsoid_of(const OGRSpatialReference& crs) { return {crs.GetSemiMajor(), crs.GetSemiMinor()}; }

bool is_earth(const Ellipsoid& body) { return std::abs(body.a / SRS_WGS84_SEMIMAJOR - 1) < 0.005; }

/// A metric projection around a place, as a word for gdalwarp -t_srs, and what files in it are called after.
struct LocalProjection {
  std::string srs, name;
};

LocalProjection local_projection(const Ellipsoid& body, double longitude, double latitude) {
  if (is_earth(body)) {
    const std::string code = std::to_string(metric_epsg(longitude, latitude));
    return {"EPSG:" + code, code};
  }
  const bool polar = std::abs(latitude) > 80;
  return {concatenate(polar ? "+proj=stere +lat_0=" : "+proj=tmerc +lat_0=",
                      polar ? std::copysign(90.0, latitude) : latitude, " +lon_0=", polar ? 0.0 : longitude,
                      " +k=1 +x_0=0 +y_0=0 +a=", body.a, " +b=", body.b, " +units=m +no_defs"),
          "metres"};
}

/// From the coordinates of a projection to longitude and latitude [deg] on its ellipsoid, and back.
class Geography {
 public:
  explicit Geography(const OGRSpatialReference& crs) : projected_(crs) {
    geographic_.CopyGeogCSFrom(&crs);
    geographic_.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    projected_.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    to_degrees_.reset(OGRCreateCoordinateTransformation(&projected_, &geographic_));
    from_degrees_.reset(OGRCreateCoordinateTransformation(&geographic_, &projected_));
  }

  struct Point {
    double x, y;
  };
  /// Nothing where they cannot be known.
  std::optional<Point> degrees(Point p) const { return transformed(to_degrees_.get(), p); }
  std::optional<Point> coordinates(Point p) const { return transformed(from_degrees_.get(), p); }

 private:
  static std::optional<Point> transformed(OGRCoordinateTransformation* transformation, Point p) {
    if (!transformation || !transformation->Transform(1, &p.x, &p.y) || !std::isfinite(p.x) ||
        !std::isfinite(p.y))
      return std::nullopt;
    return p;
  }

  OGRSpatialReference projected_, geographic_;
  std::unique_ptr<OGRCoordinateTransformation> to_degrees_, from_degrees_;
};

/// Metres of the map over metres of the ground at a place [deg], of its two axes the one that differs more
/// from 1: along the meridian and the parallel, by central differences of 0.01 degrees.
std::optional<double> map_scale(const Geography& geography, const Ellipsoid& body, Geography::Point place) {
  constexpr double half = 0.005, nearly_pole = 89.9;
  place.y = std::clamp(place.y, -nearly_pole, nearly_pole);  // at a pole there is no parallel
  const double latitude = place.y * pi / 180, e2 = 1 - body.b * body.b / (body.a * body.a);
  const double w = std::sqrt(1 - e2 * std::sin(latitude) * std::sin(latitude));
  const double along_meridian = body.a * (1 - e2) / (w * w * w),
               along_parallel = body.a / w * std::cos(latitude);
  std::optional<double> worst;
  for (const auto& [dx, dy, radius] :
       {std::tuple{0.0, half, along_meridian}, std::tuple{half, 0.0, along_parallel}}) {
    const auto from = geography.coordinates({place.x - dx, place.y - dy}),
               to = geography.coordinates({place.x + dx, place.y + dy});
    if (!from || !to) return std::nullopt;
    const double scale = std::hypot(to->x - from->x, to->y - from->y) / (radius * 2 * half * pi / 180);
    if (!worst || std::abs(std::log(scale)) > std::abs(std::log(*worst))) worst = scale;
  }
  return worst;
}

/// Transforms points of one system to another, x to the east.
class Transformation {
 public:
  Transformation(OGRSpatialReference from, const std::string& to) {
    OGRSpatialReference target;
    if (target.SetFromUserInput(to.c_str()) != OGRERR_NONE) return;
    for (OGRSpatialReference* crs : {&from, &target}) crs->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    transformation_.reset(OGRCreateCoordinateTransformation(&from, &target));
  }
  bool operator()(double& x, double& y) const {
    return transformation_ && transformation_->Transform(1, &x, &y) && std::isfinite(x) && std::isfinite(y);
  }

 private:
  std::unique_ptr<OGRCoordinateTransformation> transformation_;
};

/// Side of a square cell with the area of the raster's, at its centre [m]; to six digits.
std::optional<double> projected_cell(const Transformation& transform, const RasterExtent& e) {
  double xs[3], ys[3];
  for (int n = 0; n < 3; ++n) {
    xs[n] = e.west + (0.5 * e.width + (n == 1)) * e.cell_x;
    ys[n] = e.south + (0.5 * e.height + (n == 2)) * e.cell_y;
    if (!transform(xs[n], ys[n])) return std::nullopt;
  }
  const double area = (xs[1] - xs[0]) * (ys[2] - ys[0]) - (xs[2] - xs[0]) * (ys[1] - ys[0]);
  if (!(std::abs(area) > 0)) return std::nullopt;
  const double side = std::sqrt(std::abs(area)), digit = std::pow(10, std::floor(std::log10(side)) - 5);
  return std::round(side / digit) * digit;
}

/// -tr and -te for gdalwarp: square cells, and the largest upright rectangle of them within the raster. Empty
/// if that would leave out three tenths of it or more, as beside a pole, or cannot be known.
std::string inner_cells(const OGRSpatialReference& crs, const std::string& srs, const RasterExtent& e) {
  const Transformation transform(crs, srs);
  const std::optional<double> cell = projected_cell(transform, e);
  if (!cell) return "";
  constexpr double most = std::numeric_limits<double>::max();
  double west = -most, south = -most, east = most, north = most;
  constexpr int points = 32;  // on each edge, which is curved
  for (int n = 0; n <= points; ++n) {
    const double along_x = e.west + (e.east() - e.west) * n / points,
                 along_y = e.south + (e.north() - e.south) * n / points;
    double x[] = {e.west, e.east(), along_x, along_x}, y[] = {along_y, along_y, e.south, e.north()};
    for (int side = 0; side < 4; ++side)
      if (!transform(x[side], y[side])) return "";
    west = std::max(west, x[0]);
    east = std::min(east, x[1]);
    south = std::max(south, y[2]);
    north = std::min(north, y[3]);
  }
  const auto first = [&](double from) { return std::ceil(from / *cell) * *cell; };
  const auto last = [&](double to) { return std::floor(to / *cell) * *cell; };
  const double columns = (last(east) - first(west)) / *cell, rows = (last(north) - first(south)) / *cell;
  if (!(columns > 0 && rows > 0 && columns * rows > 0.7 * e.width * e.height)) return "";
  return concatenate(" -tr ", *cell, " ", *cell, " -te ", first(west), " ", first(south), " ", last(east),
                     " ", last(north));
}

[[noreturn]] void refuse(const std::string& path, const std::string& what, const OGRSpatialReference& crs,
                         const RasterExtent& e, const DeclaredBand& band) {
  throw_raster_error(
      path, what + ", metres are needed; project it first" +
                how_to_project(path, crs, 0.5 * (e.west + e.east()), 0.5 * (e.south + e.north()), band, &e));
}

}  // namespace

std::string unit_of_heights(const std::string& wkt) {
  const GdalMessages quiet;
  OGRSpatialReference crs;
  if (wkt.empty() || crs.importFromWkt(wkt.c_str()) != OGRERR_NONE || !crs.IsVertical()) return "";
  const char* unit = nullptr;
  const double metres = crs.GetTargetLinearUnits("VERT_CS", &unit);
  return unit && std::abs(metres - 1) > 1e-9 ? unit : "";
}

namespace {

bool points_down(const std::string& wkt) {
  const GdalMessages quiet;
  OGRSpatialReference crs;
  if (wkt.empty() || crs.importFromWkt(wkt.c_str()) != OGRERR_NONE || !crs.IsVertical()) return false;
  OGRAxisOrientation orientation = OAO_Other;
  return crs.GetAxis("VERT_CS", 0, &orientation) && orientation == OAO_Down;
}

}  // namespace

void require_heights(const std::string& path, const std::string& wkt, double scale) {
  if (scale > 0 && points_down(wkt))
    throw_raster_error(
        path, concatenate("its vertical system points down, so that its values are depths; heights are "
                          "needed: give a negative scale in the raster step (scale: ",
                          -scale, ")"));
}

std::string with_metric_heights(const std::string& wkt) {
  if (unit_of_heights(wkt).empty() && !points_down(wkt)) return wkt;
  OGRSpatialReference crs;
  crs.importFromWkt(wkt.c_str());
  crs.StripVertical();
  return wkt_of(crs);
}

std::string how_to_project(const std::string& path, const OGRSpatialReference& crs, double x, double y,
                           const DeclaredBand& band, const RasterExtent* extent) {
  std::optional<Geography::Point> place = Geography::Point{x, y};
  if (!crs.IsGeographic()) place = Geography(crs).degrees(*place);
  if (!place) return " with gdalwarp -t_srs to a projection in metres";
  const LocalProjection local = local_projection(ellipsoid_of(crs), place->x, place->y);
  const std::filesystem::path file(path);
  const std::string projected =
      (file.parent_path() / (file.stem().string() + "_" + local.name + ".tif")).string();
  // Float32 because its nodata is no height; without nodata, cells beside the raster would be 0 m high.
  const std::string wkt = wkt_of(crs);
  const bool is_depth = points_down(wkt),
             keeps_unit = is_depth || (band.has_unit && !unit_of_heights(wkt).empty());
  const char* const vertical =
      is_depth ? crs.GetAuthorityCode("VERT_CS") : nullptr;  // what is a depth stays one
  return ": gdalwarp -t_srs " + shell_word(local.srs + (vertical ? "+" + std::string(vertical) : "")) +
         (keeps_unit ? " -novshiftgrid" : "") + (extent ? inner_cells(crs, local.srs, *extent) : "") +
         (band.is_colour ? " -r near -dstalpha " : " -r bilinear -ot Float32 -dstnodata nan ") +
         shell_word(path) + " " + shell_word(projected);
}

void require_metres(const std::string& path, const std::string& wkt, const RasterExtent& extent,
                    const DeclaredBand& band) {
  if (wkt.empty()) return;
  const GdalMessages quiet;
  OGRSpatialReference crs;
  if (crs.importFromWkt(wkt.c_str()) != OGRERR_NONE) return;
  if (crs.IsGeographic()) refuse(path, "its coordinates are in degrees", crs, extent, band);
  const char* unit = nullptr;
  if (std::abs(crs.GetLinearUnits(&unit) - 1) >= 1e-9)
    refuse(path, "its coordinates are in " + (unit ? std::string("the unit ") + unit : "another unit"), crs,
           extent, band);
  const Geography geography(crs);
  const std::optional<Geography::Point> place =
      geography.degrees({0.5 * (extent.west + extent.east()), 0.5 * (extent.south + extent.north())});
  const std::optional<double> scale = place ? map_scale(geography, ellipsoid_of(crs), *place) : std::nullopt;
  constexpr double tolerance = 0.01;
  if (!scale || std::abs(*scale - 1) <= tolerance) return;
  std::ostringstream off;
  off.precision(4);
  off << "a metre of its coordinates" << (crs.GetName() ? " (" + std::string(crs.GetName()) + ")" : "")
      << " is " << 1 / *scale
      << " m of ground at its centre, 1 % is allowed: slopes and distances would be wrong";
  refuse(path, off.str(), crs, extent, band);
}

void require_projection_database(const std::string& source) {
  GdalMessages messages;
  OGRSpatialReference probe;
  if (probe.importFromEPSG(32633) == OGRERR_NONE && !messages.failed()) return;
  std::string folders;
  char** paths = OSRGetPROJSearchPaths();
  for (int n = 0; paths && paths[n]; ++n) folders += (n ? ", " : "") + std::string(paths[n]);
  CSLDestroy(paths);
  for (const char* name : {"PROJ_LIB", "PROJ_DATA"})
    if (const char* value = std::getenv(name))
      folders += std::string(folders.empty() ? "" : "; ") + name + "=" + value;
  throw ConfigError(
      source +
      ": has a projection, for which PROJ needs its database (proj.db), and it has none that it can use in " +
      (folders.empty() ? "its own folder" : folders) + ": " + messages.text() +
      "; unset PROJ_LIB and PROJ_DATA if another environment has set them");
}

}  // namespace desert_sim
