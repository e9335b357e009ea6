#include "test/support/strokes.hpp"

#include "kernels/plants/species.hpp"
#include "src/simulation/commands/edited_layers.hpp"

namespace desert_sim::test {

std::string undo_world(const std::string& name) {
  if (name == "dunes")
    return "grid: {width: 40, height: 30, cell_size: 0.5, origin_x: 100, origin_y: -50}\n"
           "terrain: [noise: {layer: bedrock, low: 0, high: 3, scale: 6}, noise: {layer: sand, low: 0, high: "
           "2}]\n"
           "wind: {speed: 7, direction_deg: 20}\nabrasion: {rate: 0.01}\n";
  if (name == "valley")
    return "grid: {width: 40, height: 30, boundary: open}\n"
           "terrain: [noise: {layer: bedrock, low: 0, high: 5, scale: 9}, noise: {layer: soil, low: 0, high: "
           "1},\n"
           "  noise: {layer: sand, low: 0, high: 1, seed: 3}, noise: {layer: water, low: 0, high: 0.5, seed: "
           "4},\n"
           "  obstacle: {x: 20, y: 15, size_x: 4, size_y: 4, height: 2}]\n"
           "wind: {speed: 6}\nrain: {rate: 1.0e-4}\n";
  if (name == "meadow")
    return "grid: {width: 40, height: 32}\n"
           "terrain: [noise: {layer: bedrock, low: 0, high: 2, scale: 8}, noise: {layer: sand, low: 0, high: "
           "3, seed: 2},\n"
           "  noise: {layer: grass, low: 0, high: 1, scale: 8, seed: 3}, noise: {layer: mesquite, low: -1, "
           "high: 1, seed: "
           "4},\n"
           "  noise: {layer: shrub, low: -0.5, high: 1, scale: 9, seed: 5}]\n"
           "wind: {speed: 8}\nsand: {model: nield_baas}\nslab_model: {slab_height: 0.1}\n"
           "slab_plants: {growth_time: 3}\n";
  return "grid: {width: 48, height: 40}\n"
         "terrain: [noise: {layer: bedrock, low: 0, high: 1, scale: 8}, uniform: {layer: soil, value: 2},\n"
         "  noise: {layer: sand, low: 0, high: 1}, uniform: {layer: moisture, value: 0.1}]\n"
         "wind: {speed: 6}\nrun: {time_step: 0.5}\nvegetation: {enabled: true}\n"
         "species: [{preset: bush, spawn: 100, moisture_lowest: 0, light_highest: 2},\n"
         "  {preset: tree, moisture_lowest: 0, light_highest: 2}]\n";
}

template <class Edit>
void RandomStrokes::place(Edit& edit) {
  const GridParameters& grid = simulation_.scenario().grid;
  const double l = grid.cell_size;
  edit.x = grid.origin_x + between(0, 1) * grid.width * l;
  edit.y = grid.origin_y + between(0, 1) * grid.height * l;
  edit.radius = between(0.5, 7) * l;
  edit.radius_y = between(0.5, 7) * l;
  edit.angle_deg = between(0, 90);
  const auto near = [&] { return command::Point{edit.x + between(-5, 5) * l, edit.y + between(-5, 5) * l}; };
  if (edit.shape == BrushShape::polygon) edit.points = {near(), near(), near(), near()};
  if (edit.shape == BrushShape::capsule) edit.points = {near(), near()};
}

Command RandomStrokes::next(const std::string& stroke) {
  const Scenario& scenario = simulation_.scenario();
  if (!scenario.species.empty() && below(2) == 0) {
    command::EditPlants edit;
    edit.operation = below(3) == 0 ? PlantEdit::clear : PlantEdit::plant;
    edit.species = edit.operation == PlantEdit::plant || below(2) ? scenario.species[below(2)].name : "";
    edit.shape = static_cast<BrushShape>(below(5));
    edit.density = between(0, 1);
    edit.size = between(0.05, 1);
    edit.seed = below(3);
    edit.stroke = stroke;
    place(edit);
    return edit;
  }
  command::EditTerrain edit;
  std::vector<EditedLayer> layers;  // those of which strokes can be undone here
  for (const EditedLayer& row : edited_layers) {
    const bool living = row.layer == Layer::vegetation && scenario.get<VegetationParameters>().enabled;
    const bool there = !row.scenarios || simulation_.terrain().has(row.layer);
    const bool hangs =
        row.layer == Layer::airborne_sand && !is_saltation(scenario.get<SandParameters>().model);
    if (there && !living && !hangs && row.kind != EditKind::fleeting) layers.push_back(row);
  }
  const EditedLayer& row = layers[below(layers.size())];
  const bool painted = row.kind == EditKind::painted;
  edit.layer = info(row.layer).name;
  edit.shape = static_cast<BrushShape>(below(6));
  edit.merge = static_cast<BrushMerge>(below(7));
  edit.inner = between(0, 1);
  edit.falloff = between(0, 2);
  edit.value = between(0, painted ? 1 : 2);
  edit.smooth_radius = 2 * scenario.grid.cell_size;
  edit.conserve = !painted && below(3) == 0;
  edit.ring_width = 3 * scenario.grid.cell_size;
  edit.stroke = stroke;
  place(edit);
  if (edit.shape == BrushShape::patch) {
    edit.patch = {3, 2, {}};
    edit.patch_use = PatchUse::mask;
    for (int n = 0; n < 6; ++n) edit.patch.values.push_back(static_cast<float>(between(0, 1)));
  }
  return edit;
}

}  // namespace desert_sim::test
