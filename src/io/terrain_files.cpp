#include "desert_sim/io/terrain_files.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/core.hpp>
#include <set>

#include "desert_sim/core/files.hpp"
#include "desert_sim/io/picture.hpp"
#include "desert_sim/io/raster.hpp"

namespace desert_sim {

namespace {

namespace fs = std::filesystem;

constexpr const char* marker = "terrain-";  // what the rasters of a saved terrain begin with

void write_layer(const std::string& path, const std::vector<float>& values, const Snapshot& s,
                 const std::string& projection) {
  Raster raster;
  raster.width = s.width;
  raster.height = s.height;
  raster.cell_size = s.cell_size;
  raster.origin_x = s.origin_x;
  raster.origin_y = s.origin_y;
  raster.projection = projection;
  raster.values = values;
  write_geotiff(path, raster);
}

/// Values are raw · scale + offset, the first row of the picture in the north.
void write_layer_png16(const std::string& path, const std::vector<float>& values, const Snapshot& s,
                       double& scale, double& offset) {
  constexpr double most = 65535;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  offset = *low;
  scale = *high > *low ? (static_cast<double>(*high) - *low) / most : 1;
  cv::Mat picture(s.height, s.width, CV_16UC1);
  for (int y = 0; y < s.height; ++y)
    for (int x = 0; x < s.width; ++x) {
      const double value = values[static_cast<std::size_t>(y) * s.width + x];
      picture.at<std::uint16_t>(s.height - 1 - y, x) =
          static_cast<std::uint16_t>(std::clamp(std::round((value - offset) / scale), 0.0, most));
    }
  write_png(path, picture);
}

void remove_rasters_but(const fs::path& folder, const std::set<std::string>& kept) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const std::string ending = entry.path().extension().string();
    const bool raster = name.rfind(marker, 0) == 0 && (ending == ".tif" || ending == ".png");
    if (raster && kept.count(name) == 0) fs::remove(entry.path());
  }
}

}  // namespace

std::vector<Layer> terrain_layers(const Simulation& simulation) {
  std::vector<Layer> layers;
  for (Layer layer : simulation.layers_in_use())
    if (info(layer).lifetime == Lifetime::persistent) layers.push_back(layer);
  return layers;
}

void save_terrain(const std::string& scenario_file, const Scenario& scenario, const Snapshot& snapshot,
                  TerrainFormat format, const std::string& tag) {
  const fs::path folder = fs::path(scenario_file).parent_path();
  Scenario saved = scenario;
  saved.terrain.clear();
  saved.grid.from_raster.clear();
  std::set<std::string> names;
  for (const auto& [layer, values] : snapshot.layers) {
    RasterStep step;
    step.layer = info(layer).name;
    step.file = marker + step.layer + "-" + tag + (format == TerrainFormat::geotiff ? ".tif" : ".png");
    const std::string path = (folder / step.file).string();
    if (format == TerrainFormat::geotiff) {
      write_layer(path, values, snapshot, scenario.projection);
      if (layer == Layer::bedrock) saved.grid.from_raster = step.file;  // for its projection
    } else {
      write_layer_png16(path, values, snapshot, step.scale, step.offset);
      step.stretch = true;  // a PNG has no place
    }
    names.insert(step.file);
    saved.terrain.push_back(step);
  }
  write_file(scenario_file, "# A terrain saved at step " + std::to_string(snapshot.step) + " of " +
                                scenario.name + ".\n" + dump_scenario(saved));
  try {
    remove_rasters_but(folder, names);
  } catch (const fs::filesystem_error& e) {
    throw ConfigError(folder.string() +
                      ": an earlier terrain's rasters cannot be removed: " + e.code().message());
  }
}

}  // namespace desert_sim
