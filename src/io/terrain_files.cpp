#include "src/io/terrain_files.hpp"

#include <xxhash.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <opencv2/core.hpp>
#include <set>

#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/core/hash_text.hpp"
#include "src/core/temporary_file.hpp"
#include "src/io/snapshots.hpp"

namespace desert_sim {

namespace {

namespace fs = std::filesystem;

/// How the files that a save writes beside its scenario file are named.
struct FileNames {
  std::string prefix;
  std::set<std::string> extensions;
};
const FileNames terrain_names{"terrain-", {".tif", ".png", ".bag"}}, state_names{"state-", {".ckpt"}};

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

/// The names of the files of earlier saves in a folder, and of those that a save was killed over.
std::set<std::string> saved_files(const fs::path& folder, const FileNames& of) {
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string(), extension = entry.path().extension().string();
    const bool whole = name.rfind(of.prefix, 0) == 0 && of.extensions.count(extension) > 0;
    const bool part = name.rfind("." + of.prefix, 0) == 0 && extension == ".part";
    if (whole || part) names.insert(name);
  }
  return names;
}

/// Removes the files of earlier saves except those in `kept`.
void remove_other_files(const fs::path& folder, const FileNames& of, const std::set<std::string>& kept) {
  for (const std::string& name : saved_files(folder, of))
    if (kept.count(name) == 0) fs::remove(folder / name);
}

/// What a scenario file begins with. A checkpoint may give any name; a line break would end the comment.
std::string comment_of(const char* start, std::uint64_t step, std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, '?');
  return start + std::to_string(step) + " of " + name + ".\n";
}

/// Writes the layers and then the scenario file. Returns the names of the files of the layers.
std::set<std::string> write_terrain(const std::string& scenario_file, const fs::path& folder,
                                    const Scenario& scenario, const Snapshot& snapshot,
                                    const LayerWriter& write_layers, const std::string& tag) {
  const SavedLayers layers = write_layers(snapshot, folder.string(), tag);
  Scenario saved = scenario;
  saved.terrain.assign(layers.steps.begin(), layers.steps.end());
  saved.grid.from_raster = layers.georeferenced;
  saved.run.start_from.clear();
  std::string comment = comment_of(saved_terrain_comment, snapshot.step, scenario.name);
  if (saved.get<VegetationParameters>().enabled)
    comment += "# Its plants are not saved: others come up when it is loaded. A checkpoint keeps them.\n";
  write_file(scenario_file, comment + dump_scenario(saved));
  std::set<std::string> names;
  for (const RasterStep& step : layers.steps) names.insert(step.file);
  return names;
}

/// Calls `write`, which returns the names of the files that it has written beside `scenario_file`, in place
/// of those of earlier saves: all of them, or none.
void replace_saved(const std::string& scenario_file, const FileNames& of,
                   const std::function<std::set<std::string>(const fs::path& folder)>& write) {
  const fs::path parent = fs::path(scenario_file).parent_path(), folder = parent.empty() ? "." : parent;
  const FolderLock lock(folder.string());
  try {
    require_writable_file(scenario_file);
    const std::set<std::string> before = saved_files(folder, of);
    std::set<std::string> written;
    try {
      written = write(folder);
    } catch (...) {
      remove_other_files(folder, of, before);
      throw;
    }
    remove_other_files(folder, of, written);
  } catch (const fs::filesystem_error& e) {
    throw WriteError(folder.string() +
                     ": the files of another save cannot be listed or removed: " + e.code().message());
  }
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
  return terrain_names.prefix + what + "-" + tag + ending;
}

LayerWriter geotiff_writer(const std::string& projection) {
  return [projection](const Snapshot& s, const std::string& folder, const std::string& tag) {
    SavedLayers saved;
    for (Layer layer : persistent_layers(s)) {
      RasterStep step;
      step.complete = true;
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
      step.complete = true;
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
  replace_saved(scenario_file, terrain_names, [&](const fs::path& folder) {
    return write_terrain(scenario_file, folder, scenario, snapshot, write_layers, tag);
  });
}

void save_scenario(const std::string& scenario_file, const Scenario& scenario, std::uint64_t step,
                   const std::string& checkpoint) {
  const std::string tag = hash_text(XXH3_64bits(checkpoint.data(), checkpoint.size()));
  replace_saved(scenario_file, state_names, [&](const fs::path& folder) -> std::set<std::string> {
    Scenario saved = scenario;
    saved.terrain.clear();
    saved.grid.from_raster.clear();
    saved.run.start_from = state_names.prefix + tag + ".ckpt";
    write_file((folder / saved.run.start_from).string(), checkpoint);
    write_file(scenario_file, comment_of(saved_scenario_comment, step, scenario.name) + dump_scenario(saved));
    return {saved.run.start_from};
  });
}

}  // namespace desert_sim
