#pragma once
/// A scenario: everything that defines a run. It is read from YAML (a file, a text, or ROS parameters that
/// were turned into YAML); config/parameters.md documents every key. All errors of a file are reported at
/// once.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kernels/base/grid.hpp"
#include "kernels/slabs/growth_curves.hpp"
#include "kernels/wind/wind_features.hpp"
#include "kernels/wind/wind_parameters.hpp"
#include "src/core/error.hpp"
#include "src/scenario/sand_model.hpp"
#include "src/scenario/sections.hpp"
#include "src/scenario/species.hpp"
#include "src/scenario/terrain_steps.hpp"
#include "src/scenario/timeline.hpp"
#include "src/scenario/wind_regime.hpp"

namespace YAML {
class Node;
}

namespace desert_sim {

enum class Boundary : int { periodic, open };
constexpr const char* boundary_names[] = {"periodic", "open"};

constexpr int max_grid_extent = 65536;  // [cells]

/// Zero means "not given"; resolve_grid() replaces it.
struct GridParameters {
  int width = 0;
  int height = 0;
  double cell_size = 0;
  Boundary boundary = Boundary::periodic;
  double origin_x = 0;
  double origin_y = 0;
  std::string from_raster;
};

constexpr auto parameter_table(const GridParameters*) {
  using P = GridParameters;
  return std::make_tuple(
      parameter("width", &P::width, 1, max_grid_extent, "cells",
                "Cells from west to east; if not given, the raster's, or 256."),
      parameter("height", &P::height, 1, max_grid_extent, "cells",
                "Cells from south to north; if not given, the raster's, or 256."),
      parameter(
          "cell_size", &P::cell_size, 1e-3, 1e4, "m",
          "Width of a cell; if not given, the raster's, or 1. The raster is resampled to another width."),
      parameter("boundary", &P::boundary, boundary_names,
                "periodic: a torus; open: sand leaves and enters over the edges."),
      parameter("origin_x", &P::origin_x, -1e8, 1e8, "m", "West edge of the grid in the terrain's frame."),
      parameter("origin_y", &P::origin_y, -1e8, 1e8, "m", "South edge of the grid in the terrain's frame."),
      parameter("from_raster", &P::from_raster,
                "A raster that gives size, cell size and origin where they are not given; cells beyond it "
                "continue its edge values."));
}
static_assert(table_is_complete<GridParameters>());

struct RunParameters {
  int steps = 1000;
  double duration = 0;
  float time_step = 1.0f;
  float hold_time = 1.0f;
  float acceleration = 0.0f;
  int check_every = 100;
  std::string start_from;
};

constexpr auto parameter_table(const RunParameters*) {
  using P = RunParameters;
  return std::make_tuple(
      parameter("steps", &P::steps, 0, 2147483647, "1", "Steps of a headless run."),
      parameter("duration", &P::duration, 0, 1e12, "s",
                "Simulated time of a headless run, which then takes as many steps as it "
                "needs; 0: run.steps counts."),
      parameter("time_step", &P::time_step, 1e-4, 1e5, "s", "Simulated time of one step."),
      parameter("hold_time", &P::hold_time, 0, 1e6, "s",
                "Time for which the wind shadow is held: steps that are shorter share that "
                "of the first of them; 0: each has its own."),
      parameter("acceleration", &P::acceleration, 0, 1e6, "1",
                "Simulated seconds per second of ROS time: the node makes acceleration / "
                "time_step steps per second; 0: its parameter step_rate says how many."),
      parameter("check_every", &P::check_every, 0, 1000000, "steps",
                "How often the state is searched for NaN and negative depths; 0 never."),
      parameter("start_from", &P::start_from,
                "Checkpoint that has the start in place of terrain steps: layers, plants, clock, wind. "
                "~save_scenario writes both; the grid must be the same."));
}
static_assert(table_is_complete<RunParameters>());

/// Limits of run.acceleration where it is not 0, so that neither steps nor seconds of ROS time become
/// countless.
constexpr double max_accelerated_rate = 10000;  // [steps/s]
constexpr double min_acceleration = 1e-6;

constexpr std::size_t max_wind_features = 64;

struct Scenario {
  std::string name;    ///< file name without extension, or the caller's name for it
  std::string folder;  ///< relative raster paths are looked up here first
  std::uint64_t seed = 1;
  GridParameters grid;
  std::vector<TerrainStep> terrain;
  WindRegimeParameters wind_regime;
  std::vector<WindSegment> wind_segments;
  std::shared_ptr<const WindSeries> wind_series;  ///< what wind.series_file has; see read_wind_series()
  std::vector<WindFeature> wind_features;         ///< at most max_wind_features
  WindParameters wind;                            ///< at the surface
  std::vector<Species> species;                   ///< at most max_species
  CompetitionMatrix competition;                  ///< as many rows and columns as there are species
  GrowthCurves growth_curves;                     ///< of the slab model nield_baas
  Sections sections;                              ///< of the processes
  RunParameters run;
  std::vector<TimelineEntry> timeline;  ///< in order of time
  std::string projection;               ///< WKT of the raster that gave the grid; kept for what is written

  /// The parameters of a section, by their type. Throws Error if it is not registered.
  template <class P>
  const P& get() const {
    return sections.get<P>();
  }
  template <class P>
  P& get() {
    return sections.get<P>();
  }
  Grid make_grid() const;
};

/// `path=value` settings that override keys, as given to --set: "grid.width=128",
/// "terrain.0.raster.file=dem.tif".
using Settings = std::vector<std::string>;

/// These functions read and check a scenario. They throw ConfigError that lists all errors, each with file,
/// key, value and allowed range.
/// A file has at most max_scenario_bytes, and lies below `folder` if one is given.
constexpr std::uint64_t max_scenario_bytes = std::uint64_t{1} << 24;
Scenario load_scenario(const std::string& path, const Settings& settings = {},
                       const std::string& folder = "");
/// `folder`: which relative paths of files in it begin at.
Scenario parse_scenario_text(const std::string& yaml, const std::string& name, const Settings& settings = {},
                             const std::string& folder = "");
Scenario parse_scenario(const YAML::Node& root, const std::string& name, const std::string& folder);
/// What the file of a saved terrain, or of a scenario saved with its state, begins with.
constexpr const char* saved_terrain_comment = "# A terrain saved at step ";
constexpr const char* saved_scenario_comment = "# A scenario saved at step ";
/// Overrides one key of a scenario's YAML. Throws ConfigError.
void apply_setting(YAML::Node root, const std::string& setting);
/// The folder of a file, with the slash; "." of a name alone. The name of a file without its extension.
std::string parent_folder(const std::string& path);
std::string base_name(const std::string& path);
/// The scenario as YAML with all parameters, defaults included. Of a scenario whose grid is resolved,
/// parse_scenario() reads back the same one.
std::string dump_scenario(const Scenario& scenario);

/// All parameters as a markdown page, which `desert_run --describe` prints and config/parameters.md contains.
std::string describe_parameters();

}  // namespace desert_sim
