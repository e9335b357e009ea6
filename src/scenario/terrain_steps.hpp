#pragma once
/// The steps of a scenario's `terrain` list. They are run in order, and each fills or changes a layer.
/// Positions are metres in the terrain's frame or, with `relative`, fractions of the grid's extent.

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>

#include "src/core/parameter_table.hpp"
#include "src/scenario/raster_encoding.hpp"

namespace desert_sim {

enum class Merge : int { replace, add, max };
constexpr const char* merge_names[] = {"replace", "add", "max"};

/// The same value everywhere.
struct UniformStep {
  std::string layer = "bedrock";
  Merge merge = Merge::replace;
  double value = 0;
};
constexpr auto parameter_table(const UniformStep*) {
  using P = UniformStep;
  return std::make_tuple(
      parameter("layer", &P::layer, "Layer to fill."),
      parameter("merge", &P::merge, merge_names, "How the step's value is combined with the present one."),
      parameter("value", &P::value, -1e6, 1e6, "layer's", "Value."));
}
static_assert(table_is_complete<UniformStep>());

/// Noise between `low` and `high`. With scale 0 it is white noise: each cell has an independent uniform
/// value, as in the scenes of the papers. Otherwise it is a sum of octaves of smooth noise whose largest
/// features measure `scale` metres. It repeats on periodic axes.
struct NoiseStep {
  std::string layer = "sand";
  Merge merge = Merge::replace;
  double low = 0;
  double high = 1;
  double scale = 0;
  int octaves = 4;
  double stretch = 1;
  double threshold = 0;
  std::uint64_t seed = 0;
};
constexpr auto parameter_table(const NoiseStep*) {
  using P = NoiseStep;
  return std::make_tuple(
      parameter("layer", &P::layer, "Layer to fill."),
      parameter("merge", &P::merge, merge_names, "How the step's value is combined with the present one."),
      parameter("low", &P::low, -1e6, 1e6, "layer's", "Value where the noise is lowest."),
      parameter("high", &P::high, -1e6, 1e6, "layer's", "Value where the noise is highest."),
      parameter("scale", &P::scale, 0, 1e6, "m", "Size of the largest features; 0 is white noise."),
      parameter("octaves", &P::octaves, 1, 12, "1",
                "Number of octaves; each has half the size and amplitude of the one before."),
      parameter("stretch", &P::stretch, 0.01, 100, "1",
                "Length of features along x over their length along y."),
      parameter("threshold", &P::threshold, 0, 1, "1",
                "Lower share of the noise's range that is set to low."),
      parameter("seed", &P::seed, 0, highest_uint64, "1", "Added to the scenario's seed."));
}
static_assert(table_is_complete<NoiseStep>());

/// An inclined plane with `value` at the grid's centre.
struct RampStep {
  std::string layer = "bedrock";
  Merge merge = Merge::replace;
  double value = 0;
  double slope_x = 0;
  double slope_y = 0;
};
constexpr auto parameter_table(const RampStep*) {
  using P = RampStep;
  return std::make_tuple(
      parameter("layer", &P::layer, "Layer to fill."),
      parameter("merge", &P::merge, merge_names, "How the step's value is combined with the present one."),
      parameter("value", &P::value, -1e6, 1e6, "layer's", "Value at the grid's centre."),
      parameter("slope_x", &P::slope_x, -100, 100, "1/m", "Rise per metre east."),
      parameter("slope_y", &P::slope_y, -100, 100, "1/m", "Rise per metre north."));
}
static_assert(table_is_complete<RampStep>());

enum class HillShape : int { cone, gaussian, dome };
constexpr const char* hill_shape_names[] = {"cone", "gaussian", "dome"};

/// A round hill, or with a negative height a hollow.
struct ConeStep {
  std::string layer = "sand";
  Merge merge = Merge::add;
  HillShape shape = HillShape::cone;
  bool relative = false;
  double x = 0;
  double y = 0;
  double radius = 10;
  double height = 5;
};
constexpr auto parameter_table(const ConeStep*) {
  using P = ConeStep;
  return std::make_tuple(
      parameter("layer", &P::layer, "Layer to change."),
      parameter("merge", &P::merge, merge_names, "How the step's value is combined with the present one."),
      parameter("shape", &P::shape, hill_shape_names, "cone; gaussian (radius is sigma); dome (paraboloid)."),
      parameter("relative", &P::relative, "Whether x and y are shares of the grid's extent."),
      parameter("x", &P::x, -1e8, 1e8, "m", "Centre."), parameter("y", &P::y, -1e8, 1e8, "m", "Centre."),
      parameter("radius", &P::radius, 1e-3, 1e6, "m", "Radius of the base, or sigma."),
      parameter("height", &P::height, -1e5, 1e5, "layer's", "Height of the top."));
}
static_assert(table_is_complete<ConeStep>());

enum class Footprint : int { box, cylinder };
constexpr const char* footprint_names[] = {"box", "cylinder"};

/// A column with vertical walls, such as a block of sand or rock, or a patch of vegetation.
struct ColumnStep {
  std::string layer = "sand";
  Merge merge = Merge::add;
  Footprint shape = Footprint::box;
  bool relative = false;
  double x = 0;
  double y = 0;
  double size_x = 10;
  double size_y = 10;
  double angle_deg = 0;
  double height = 5;
};
constexpr auto parameter_table(const ColumnStep*) {
  using P = ColumnStep;
  return std::make_tuple(
      parameter("layer", &P::layer, "Layer to change."),
      parameter("merge", &P::merge, merge_names, "How the step's value is combined with the present one."),
      parameter("shape", &P::shape, footprint_names, "Outline seen from above."),
      parameter("relative", &P::relative, "Whether x and y are shares of the grid's extent."),
      parameter("x", &P::x, -1e8, 1e8, "m", "Centre."), parameter("y", &P::y, -1e8, 1e8, "m", "Centre."),
      parameter("size_x", &P::size_x, 0, 1e7, "m",
                "Length along the first axis; for a cylinder the diameter."),
      parameter("size_y", &P::size_y, 0, 1e7, "m",
                "Length along the second axis; for a cylinder the diameter."),
      parameter("angle_deg", &P::angle_deg, -360, 360, "deg",
                "Direction of the first axis, counter-clockwise from +x."),
      parameter("height", &P::height, -1e5, 1e5, "layer's",
                "Height, or value of a layer that is not a height."));
}
static_assert(table_is_complete<ColumnStep>());

/// Discs at random positions, added until they cover a share of the grid.
struct DiscsStep {
  std::string layer = "sand";
  Merge merge = Merge::max;
  double coverage = 0.2;
  double radius_low = 5;
  double radius_high = 10;
  double height = 2;
  std::uint64_t seed = 0;
};
constexpr auto parameter_table(const DiscsStep*) {
  using P = DiscsStep;
  return std::make_tuple(
      parameter("layer", &P::layer, "Layer to change."),
      parameter("merge", &P::merge, merge_names, "How a disc's value is combined with the present one."),
      parameter("coverage", &P::coverage, 0, 0.95, "1", "Share of the cells that discs cover."),
      parameter("radius_low", &P::radius_low, 1e-3, 1e6, "m", "Smallest radius."),
      parameter("radius_high", &P::radius_high, 1e-3, 1e6, "m", "Largest radius."),
      parameter("height", &P::height, 0, 1e5, "layer's", "Height, or value of a layer that is not a height."),
      parameter("seed", &P::seed, 0, highest_uint64, "1", "Added to the scenario's seed."));
}
static_assert(table_is_complete<DiscsStep>());

/// A solid object: the step raises the bedrock by `height` and marks the cells as obstacle.
struct ObstacleStep {
  Footprint shape = Footprint::cylinder;
  bool relative = false;
  double x = 0;
  double y = 0;
  double size_x = 10;
  double size_y = 10;
  double angle_deg = 0;
  double height = 10;
};
constexpr auto parameter_table(const ObstacleStep*) {
  using P = ObstacleStep;
  return std::make_tuple(
      parameter("shape", &P::shape, footprint_names, "Outline seen from above."),
      parameter("relative", &P::relative, "Whether x and y are shares of the grid's extent."),
      parameter("x", &P::x, -1e8, 1e8, "m", "Centre."), parameter("y", &P::y, -1e8, 1e8, "m", "Centre."),
      parameter("size_x", &P::size_x, 1e-3, 1e7, "m",
                "Length along the first axis; for a cylinder the diameter."),
      parameter("size_y", &P::size_y, 1e-3, 1e7, "m",
                "Length along the second axis; for a cylinder the diameter."),
      parameter("angle_deg", &P::angle_deg, -360, 360, "deg",
                "Direction of the first axis, counter-clockwise from +x."),
      parameter("height", &P::height, 0, 1e5, "m", "Height above the ground."));
}
static_assert(table_is_complete<ObstacleStep>());

/// Straight ripples across a wind: ridges with plane flanks and sharp crests. The windward flank rises over
/// the share `windward` of the wavelength, the lee flank falls over the rest. On a periodic axis they fit
/// together where a whole number of wavelengths fits the grid.
struct RipplesStep {
  std::string layer = "sand";
  Merge merge = Merge::add;
  double wavelength = 2;
  double height = 0.2;
  double windward = 0.5;
  double direction_deg = 0;
  bool relative = false;
  double x = 0;
  double y = 0;
  int count = 0;
};
constexpr auto parameter_table(const RipplesStep*) {
  using P = RipplesStep;
  return std::make_tuple(
      parameter("layer", &P::layer, "Layer to change."),
      parameter("merge", &P::merge, merge_names, "How the step's value is combined with the present one."),
      parameter("wavelength", &P::wavelength, 1e-3, 1e6, "m", "Distance from crest to crest."),
      parameter("height", &P::height, -1e5, 1e5, "layer's", "Height of the crests above the troughs."),
      parameter("windward", &P::windward, 0.01, 0.99, "1",
                "Share of the wavelength that rises with the wind."),
      parameter("direction_deg", &P::direction_deg, -360, 360, "deg",
                "Where the wind moves to, counter-clockwise from +x."),
      parameter("relative", &P::relative, "Whether x and y are shares of the grid's extent."),
      parameter("x", &P::x, -1e8, 1e8, "m", "A point in the trough before the first ripple."),
      parameter("y", &P::y, -1e8, 1e8, "m", "A point in the trough before the first ripple."),
      parameter("count", &P::count, 0, 1000000, "1", "Number of ripples from there on; 0: everywhere."));
}
static_assert(table_is_complete<RipplesStep>());

/// Fills a layer from a raster: value = raw · scale + offset.
struct RasterStep {
  std::string layer = "bedrock";
  Merge merge = Merge::replace;
  std::string file;
  int band = 1;
  double scale = 1;
  double offset = 0;
  RasterEncoding encoding = RasterEncoding::values;
  std::optional<double> nodata;
  bool fill_nodata = false;
  bool complete = false;
  bool stretch = false;
};
constexpr auto parameter_table(const RasterStep*) {
  using P = RasterStep;
  return std::make_tuple(
      parameter("layer", &P::layer, "Layer to fill."),
      parameter("merge", &P::merge, merge_names, "How the step's value is combined with the present one."),
      parameter("file", &P::file,
                "Path, absolute or relative to the scenario's folder; empty: grid.from_raster."),
      parameter("band", &P::band, 1, 10000, "1", "Band of the raster."),
      parameter("scale", &P::scale, -1e9, 1e9, "layer's",
                "Factor applied to the raster's values, after the scale, the offset and the unit of length "
                "that the "
                "file declares."),
      parameter("offset", &P::offset, -1e9, 1e9, "layer's", "Added after the factor."),
      parameter(
          "encoding", &P::encoding, raster_encoding_names,
          "What the file's numbers are. values: those of one band; channel: of one band, also where it is a "
          "colour or the index of a palette; terrarium, mapbox: heights that red, green and blue encode, 256 "
          "red + green + blue / 256 - 32768 m and (65536 red + 256 green + blue) / 10 - 10000 m."),
      parameter(
          "nodata", &P::nodata, -std::numeric_limits<double>::max(), std::numeric_limits<double>::max(),
          "raster's",
          "Value in the raster that stands for missing data, besides the one that the file declares; not "
          "given: none."),
      parameter("fill_nodata", &P::fill_nodata,
                "Whether cells without data are filled from their neighbours; otherwise they are refused."),
      parameter("complete", &P::complete,
                "Whether every cell has data, as in saved terrains; otherwise a warning tells numbers that "
                "seem to stand for missing data."),
      parameter("stretch", &P::stretch,
                "Whether the raster is stretched over the grid, wherever it lies; always so if it is not "
                "georeferenced."));
}
static_assert(table_is_complete<RasterStep>());

using TerrainStep = std::variant<UniformStep, NoiseStep, RampStep, ConeStep, ColumnStep, DiscsStep,
                                 RipplesStep, ObstacleStep, RasterStep>;
constexpr const char* terrain_step_names[] = {"uniform", "noise",   "ramp",     "cone",  "column",
                                              "discs",   "ripples", "obstacle", "raster"};

}  // namespace desert_sim
