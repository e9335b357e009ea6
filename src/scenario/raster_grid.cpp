#include "src/scenario/raster_grid.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "src/scenario/range_checks.hpp"

namespace desert_sim {

RasterField no_raster_loader(const RasterRequest& request) {
  throw ConfigError(request.path + ": this build cannot read rasters (it was built without GDAL)");
}

namespace {

/// The size of a grid that follows from its raster.
int cells_of(const char* key, double cells, const Scenario& s) {
  if (!(cells < max_grid_extent + 0.5))
    throw ConfigError(s.name + ": grid." + key + ": " + std::to_string(std::llround(cells)) +
                      " cells by the raster " + s.grid.from_raster + ", is not in [1, " +
                      std::to_string(max_grid_extent) + "]; grid.cell_size makes it smaller");
  return std::max(1, static_cast<int>(std::lround(cells)));
}

}  // namespace

void resolve_grid(Scenario& s, const RasterLoader& load_raster) {
  GridParameters& g = s.grid;
  if (!g.from_raster.empty()) {
    RasterRequest request;
    request.path = raster_path(s, g.from_raster);
    const bool resampled = g.cell_size > 0;
    const RasterField raster = load_raster(request);
    const double cell = resampled ? g.cell_size : raster.cell_size;
    const double extent_x = raster.width * raster.cell_size, extent_y = raster.height * raster.cell_size;
    const bool sized = g.width > 0 || g.height > 0;
    if (g.width == 0) g.width = cells_of("width", extent_x / cell, s);
    if (g.height == 0) g.height = cells_of("height", extent_y / cell, s);
    if (g.origin_x == 0 && g.origin_y == 0) {
      // A grid whose size the scenario gives is centred on the raster.
      g.origin_x = raster.origin_x + (sized ? 0.5 * (extent_x - g.width * cell) : 0.0);
      g.origin_y = raster.origin_y + (sized ? 0.5 * (extent_y - g.height * cell) : 0.0);
    }
    g.cell_size = cell;
    s.projection = raster.projection;
  }
  if (g.width == 0) g.width = 256;
  if (g.height == 0) g.height = 256;
  if (g.cell_size == 0) g.cell_size = 1;
  const bool placed_by_raster = !g.from_raster.empty() && s.projection.empty();  // in degrees, perhaps
  check_ranges(g, s.name + ": grid" +  // a raster can have any size and place
                      (placed_by_raster ? " of " + g.from_raster + ", which declares no projection" : ""));
}

std::string raster_path(const Scenario& s, const std::string& file) {
  if (file.empty() || file[0] == '/') return file;
  const std::string beside =
      s.folder.empty() || s.folder.back() == '/' ? s.folder + file : s.folder + "/" + file;
  std::error_code error;
  return std::filesystem::exists(beside, error) ? beside : file;
}

std::vector<std::string> raster_paths(const Scenario& s) {
  std::vector<std::string> paths;
  if (!s.grid.from_raster.empty()) paths.push_back(raster_path(s, s.grid.from_raster));
  for (const TerrainStep& step : s.terrain)
    if (const auto* raster = std::get_if<RasterStep>(&step); raster && !raster->file.empty())
      paths.push_back(raster_path(s, raster->file));
  for (const TimelineEntry& entry : s.timeline)
    if (const std::string file = timeline_raster(entry); !file.empty()) paths.push_back(raster_path(s, file));
  return paths;
}

}  // namespace desert_sim
