#include "src/tools/micro_relief_output.hpp"

#include <cmath>

#include "src/core/error.hpp"
#include "src/core/number_text.hpp"
#include "src/tools/points.hpp"
#if DESERT_WITH_IO
#include "src/io/raster.hpp"
#endif

namespace desert_sim {

namespace {

constexpr double coarsest = 1000;  // [m]
constexpr double most_points = 1 << 26;

MicroReliefWindow window_of(const std::string& option, const GridParameters& grid) {
  const std::string what = "--micro-relief " + option, key = ",resolution=";
  const std::size_t comma = option.find(key);
  const std::vector<double> corners = numbers_of(option.substr(0, comma), 4);
  const std::vector<double> resolution = comma == std::string::npos
                                             ? std::vector<double>{0.05}
                                             : numbers_of(option.substr(comma + key.size()), 1);
  if (corners.empty() || resolution.empty())
    throw ConfigError(what + ": must be x1,y1,x2,y2 or x1,y1,x2,y2,resolution=metres");
  require_on_grid(corners[0], corners[1], grid, what);
  require_on_grid(corners[2], corners[3], grid, what);
  const double length_x = corners[2] - corners[0], length_y = corners[3] - corners[1];
  if (!(length_x > 0 && length_y > 0))
    throw ConfigError(what + ": (x2, y2) must lie to the north-east of (x1, y1)");
  if (!(resolution[0] >= finest_detail && resolution[0] <= coarsest))
    throw ConfigError(what + ": resolution = " + number_text(resolution[0]) + " m is not in [" +
                      number_text(finest_detail, 10) + ", " + number_text(coarsest, 10) + "] m");
  const double columns = std::max(1.0, std::round(length_x / resolution[0])),
               rows = std::max(1.0, std::round(length_y / resolution[0]));
  if (columns * rows > most_points)
    throw ConfigError(what + ": " + number_text(columns, 10) + " x " + number_text(rows, 10) +
                      " points are too many (allowed: at most " + number_text(most_points, 10) + ")");
  return {corners[0], corners[1], static_cast<int>(columns), static_cast<int>(rows), resolution[0]};
}

}  // namespace

std::vector<MicroReliefWindow> micro_relief_windows(const std::vector<std::string>& options,
                                                    const GridParameters& grid) {
#if !DESERT_WITH_IO
  if (!options.empty())
    throw ConfigError("--micro-relief: this build writes no rasters (it lacks GDAL and OpenCV)");
#endif
  std::vector<MicroReliefWindow> windows;
  windows.reserve(options.size());
  for (const std::string& option : options) windows.push_back(window_of(option, grid));
  return windows;
}

std::vector<float> rippled_elevations(Simulation& simulation, const MicroReliefWindow& window) {
  const RowBand rows = MicroRelief::band(window, *simulation.views().snapshot({}));
  return MicroRelief(*simulation.views().snapshot(MicroRelief::layers(), rows, true)).elevations(window);
}

void write_micro_relief([[maybe_unused]] const std::string& folder, [[maybe_unused]] Simulation& simulation,
                        [[maybe_unused]] const std::vector<MicroReliefWindow>& windows) {
#if DESERT_WITH_IO
  for (std::size_t n = 0; n < windows.size(); ++n) {
    const MicroReliefWindow& w = windows[n];
    Raster raster;
    raster.width = w.columns;
    raster.height = w.rows;
    raster.cell_size = w.resolution;
    raster.origin_x = w.x0;
    raster.origin_y = w.y0;
    raster.projection = simulation.scenario().projection;
    raster.values = rippled_elevations(simulation, w);
    write_geotiff(folder + "/micro_relief" + (n > 0 ? "_" + std::to_string(n + 1) : "") + ".tif", raster);
  }
#endif
}

}  // namespace desert_sim
