#include "src/io/terrain_files.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <opencv2/core.hpp>
#include <set>

#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/core/temporary_file.hpp"
#include "src/io/snapshots.hpp"

namespace desert_sim {

namespace {

namespace fs = std::filesystem;

constexpr const char* file_prefix = "terrain-";  // prefix of the files of a saved terrain
const std::set<std::string> saved_extensions{".tif", ".png", ".bag"};

/// Writes a 16-bit PNG, north up, and sets scale and offset: value = raw · scale + offset.
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

/// The names of the files of saved terrains in a folder, and of those that a save was killed over.
std::set<std::string> saved_files(const fs::path& folder) {
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string(), extension = entry.path().extension().string();
    const bool whole = name.rfind(file_prefix, 0) == 0 && saved_extensions.count(extension) > 0;
    const bool part = name.rfind("." + std::string(file_prefix), 0) == 0 && extension == ".part";
    if (whole || part) names.insert(name);
  }
  return names;
}

/// Removes the files of saved terrains except those in `kept`.
void remove_other_files(const fs::path& folder, const std::set<std::string>& kept) {
  for (const std::string& name : saved_files(folder))
    if (kept.count(name) == 0) fs::remove(folder / name);
}

/// Writes the layers and then the scenario file. Returns the names of the files of the layers.
std::set<std::string> write_terrain(const std::string& scenario_file, const fs::path& folder,
                                    const Scenario& scenario, const Snapshot& snapshot,
                                    const LayerWriter& write_layers, const std::string& tag) {
  const SavedLayers layers = write_layers(snapshot, folder.string(), tag);
  Scenario saved = scenario;
  saved.terrain.assign(layers.steps.begin(), layers.steps.end());
  saved.grid.from_raster = layers.georeferenced;
  std::string name = scenario.name;  // a checkpoint may give any; a line break would end the comment
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, '?');
  std::string comment = saved_terrain_comment + std::to_string(snapshot.step) + " of " + name + ".\n";
  if (saved.get<VegetationParameters>().enabled)
    comment += "# Its plants are not saved: others come up when it is loaded. A checkpoint keeps them.\n";
  write_file(scenario_file, comment + dump_scenario(saved));
  std::set<std::string> names;
  for (const RasterStep& step : layers.steps) names.insert(step.file);
  return names;
}

}  // namespace

std::vector<Layer> persistent_layers(const Simulation& simulation) {
  const bool plants = simulation.scenario().get<VegetationParameters>().enabled;
  std::vector<Layer> layers;
  for (Layer layer : simulation.state().layers_in_use())
    if (info(layer).lifetime == Lifetime::persistent && !(plants && layer == Layer::vegetation))
      layers.push_back(layer);
  return layers;
}

std::vector<Layer> persistent_layers(const Snapshot& snapshot) {
  std::vector<Layer> layers;
  for (const auto& entry : snapshot.layers)
    if (info(entry.first).lifetime == Lifetime::persistent) layers.push_back(entry.first);
  return layers;
}

std::string layer_file_name(const std::string& what, const std::string& tag, const std::string& ending) {
  return file_prefix + what + "-" + tag + ending;
}

LayerWriter geotiff_writer(const std::string& projection) {
  return [projection](const Snapshot& s, const std::string& folder, const std::string& tag) {
    SavedLayers saved;
    for (Layer layer : persistent_layers(s)) {
      RasterStep step;
      step.layer = info(layer).name;
      step.file = layer_file_name(step.layer, tag, ".tif");
      write_geotiff(folder + "/" + step.file, to_raster(s, *s.find(layer), projection));
      saved.georeferenced = step.file;
      saved.steps.push_back(step);
    }
    return saved;
  };
}

LayerWriter png16_writer() {
  return [](const Snapshot& s, const std::string& folder, const std::string& tag) {
    SavedLayers saved;
    for (Layer layer : persistent_layers(s)) {
      RasterStep step;
      step.layer = info(layer).name;
      step.file = layer_file_name(step.layer, tag, ".png");
      write_layer_png16(folder + "/" + step.file, *s.find(layer), s, step.scale, step.offset);
      step.stretch = true;  // a PNG has no georeference
      saved.steps.push_back(step);
    }
    return saved;
  };
}

void save_terrain(const std::string& scenario_file, const Scenario& scenario, const Snapshot& snapshot,
                  const LayerWriter& write_layers, const std::string& tag) {
  const fs::path parent = fs::path(scenario_file).parent_path(), folder = parent.empty() ? "." : parent;
  const FolderLock lock(folder.string());
  try {
    require_writable_file(scenario_file);
    const std::set<std::string> before = saved_files(folder);
    std::set<std::string> written;
    try {
      written = write_terrain(scenario_file, folder, scenario, snapshot, write_layers, tag);
    } catch (...) {
      remove_other_files(folder, before);
      throw;
    }
    remove_other_files(folder, written);
  } catch (const fs::filesystem_error& e) {
    throw WriteError(folder.string() +
                     ": the files of another terrain cannot be listed or removed: " + e.code().message());
  }
}

}  // namespace desert_sim
