#include "src/export/snapshot_scene.hpp"

#include <cstdint>
#include <string>
#include <utility>

#include "src/terrain/map_layers.hpp"

namespace desert_sim {

render::LayerWindow layer_windows(const Snapshot& s) {
  return [&s](const std::string& name, const render::CellRectangle& wanted) {
    const MapLayer* const layer = find_map_layer(name);
    const std::vector<float>* const values = layer ? s.find(layer->layer) : nullptr;
    if (!values) return render::CellWindow();
    const render::CellRectangle cells = wanted.clipped({0, 0, s.width, s.height});
    std::vector<float> part;
    part.reserve(static_cast<std::size_t>(cells.width) * static_cast<std::size_t>(cells.height));
    for (int y = cells.y; y < cells.top(); ++y) {
      const auto row = values->begin() + static_cast<std::ptrdiff_t>(y) * s.width;
      part.insert(part.end(), row + cells.x, row + cells.right());
    }
    return render::CellWindow(cells, std::move(part));
  };
}

std::vector<Layer> layers_of(const render::TerrainLook& look) {
  std::vector<Layer> layers;
  for (const std::string& name : render::layers_for(look))
    if (const MapLayer* layer = find_map_layer(name)) layers.push_back(layer->layer);
  return layers;
}

render::Mesh plants_of(const PlantList& list, double exaggeration, bool light) {
  std::vector<render::Plant> shapes;
  std::vector<std::uint8_t> species;
  for (const plants::PlantRecord& plant : list.plants) {
    shapes.push_back({static_cast<double>(plant.x), static_cast<double>(plant.y),
                      static_cast<double>(plant.z), static_cast<double>(plant.radius),
                      static_cast<double>(list.species[plant.species].traits.stem), plant.health / 255.0});
    species.push_back(plant.species);
  }
  render::PlantLook look;
  look.vertical_exaggeration = exaggeration;
  look.light = light;
  for (const Species& kind : list.species) look.colours.push_back(render::crown_colour(kind.appearance.hue));
  return render::plants_mesh(shapes, species, look);
}

}  // namespace desert_sim
