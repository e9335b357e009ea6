#include "src/scenario/band_terrain.hpp"

#include <algorithm>

#include "kernels/field/layers.hpp"
#include "src/core/joined.hpp"
#include "src/core/quoted.hpp"
#include "src/scenario/raster_grid.hpp"

namespace desert_sim {

namespace {

const std::string bag_extension = ".bag";

/// Number of the layer's band, counted from 1; 0 if there is none.
int find_band(const std::string& layer, const std::vector<std::string>& bands) {
  for (const std::string& name : {layer, layer + "_depth"}) {
    const auto found = std::find(bands.begin(), bands.end(), name);
    if (found != bands.end()) return static_cast<int>(found - bands.begin()) + 1;
  }
  return 0;
}

}  // namespace

bool is_bag(const std::string& path) {
  return path.size() >= bag_extension.size() &&
         path.compare(path.size() - bag_extension.size(), bag_extension.size(), bag_extension) == 0;
}

Scenario scenario_from_bands(const std::string& path, const RasterLoader& load_raster, bool fill_nodata) {
  RasterRequest request;
  request.path = path;
  const std::vector<std::string> bands = load_raster(request).bands;
  Scenario s;
  s.name = path;
  s.grid.from_raster = path;
  s.grid.boundary = Boundary::open;
  const auto add = [&](Layer layer, int band, Merge merge, double scale) {
    RasterStep step;
    step.layer = info(layer).name;
    step.merge = merge;
    step.band = band;
    step.scale = scale;
    step.fill_nodata = fill_nodata;
    if (band > 0) s.terrain.push_back(step);
  };
  const int bedrock = find_band("bedrock", bands), elevation = find_band("elevation", bands);
  if (bedrock == 0 && elevation == 0)
    throw ConfigError(path + ": contains neither a layer bedrock nor a layer elevation (it contains: " +
                      shortened(joined(bands)) + ")");
  add(Layer::bedrock, bedrock > 0 ? bedrock : elevation, Merge::replace, 1);
  for (const LayerInfo& layer : layer_table) {
    if (layer.lifetime != Lifetime::persistent || layer.layer == Layer::bedrock) continue;
    const int band = find_band(layer.name, bands);
    add(layer.layer, band, Merge::replace, 1);
    if (bedrock == 0 && (layer.layer == Layer::sand || layer.layer == Layer::soil))
      add(Layer::bedrock, band, Merge::add, -1);
  }
  return s;
}

}  // namespace desert_sim
