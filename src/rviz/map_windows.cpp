#include "src/rviz/map_windows.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "kernels/view/cell_cost.hpp"

namespace desert_sim {

namespace {

std::vector<float> costs_in(const LayerMap& traversability, const render::CellRectangle& cells) {
  std::vector<float> values = values_in(traversability, cells);
  for (float& value : values)
    if (!std::isnan(value)) value = cell_cost::of(value);
  return values;
}

std::vector<float> change_in(const LayerMap& now, const LayerMap& before,
                             const render::CellRectangle& cells) {
  std::vector<float> values = values_in(now, cells);
  const std::vector<float> others = values_in(before, cells);
  for (std::size_t n = 0; n < values.size(); ++n) values[n] -= others[n];
  return values;
}

}  // namespace

std::string source_of_layer(const std::string& layer) {
  return layer == cost_layer ? "traversability" : layer;
}

void keep_layers(const std::vector<std::string>& layers, LayerMaps& maps) {
  for (auto map = maps.begin(); map != maps.end();)
    map = std::find(layers.begin(), layers.end(), map->first) == layers.end() ? maps.erase(map)
                                                                              : std::next(map);
}

std::vector<float> values_in(const LayerMap& map, const render::CellRectangle& cells) {
  return map.values({static_cast<std::uint32_t>(cells.x), static_cast<std::uint32_t>(cells.y),
                     static_cast<std::uint32_t>(cells.width), static_cast<std::uint32_t>(cells.height)});
}

render::LayerWindow windows_of(const LayerMaps& maps, const std::shared_ptr<const LayerMap>& reference) {
  return
      [maps, reference](const std::string& layer, const render::CellRectangle& cells) -> render::CellWindow {
        const auto elevation = maps.find("elevation");
        const auto found = maps.find(layer == render::change_layer ? "elevation" : source_of_layer(layer));
        if (elevation == maps.end() || found == maps.end()) return {};
        const LayerMap &ground = *elevation->second, &map = *found->second;
        if (!map.same_geometry(ground)) return {};
        if (layer == render::change_layer) {
          const bool comparable = reference && reference->same_geometry(ground);
          return comparable ? render::CellWindow(cells, change_in(ground, *reference, cells))
                            : render::CellWindow();
        }
        return {cells, layer == cost_layer ? costs_in(map, cells) : values_in(map, cells)};
      };
}

}  // namespace desert_sim
