#include "src/export/exported_terrain.hpp"

#include <algorithm>
#include <limits>

#include "src/core/error.hpp"
#include "src/core/number_text.hpp"
#include "src/export/snapshot_scene.hpp"
#include "src/render/terrain_colours.hpp"

namespace desert_sim {

namespace {

render::TerrainLook look_of_export(const render::Palette& palette = {}) {
  render::TerrainLook look;
  look.palette = palette;
  look.light = false;
  return look;
}

render::Colour unpacked(render::PackedColour packed) {
  const auto channel = [packed](int shift) { return static_cast<float>(packed >> shift & 255) / 255; };
  return {channel(0), channel(8), channel(16)};
}

}  // namespace

std::vector<Layer> layers_to_export() { return layers_of(look_of_export()); }

ExportedTerrain terrain_to_export(Simulation& simulation) {
  ExportedTerrain terrain;
  terrain.snapshot = simulation.views().snapshot(layers_to_export());
  terrain.plants = simulation.views().begin_plants().get();
  return terrain;
}

void require_surface(const std::string& file, int width, int height) {
  if (std::min(width, height) < 2)
    throw ConfigError(file + ": a terrain of " + std::to_string(width) + " x " + std::to_string(height) +
                      " cells has no surface that a mesh could show (allowed: at least 2 x 2)");
}

TerrainMeshes meshes_of(const std::string& file, const ExportedTerrain& terrain) {
  const Snapshot& s = *terrain.snapshot;
  const render::TerrainGrid grid{render::BlockLayout::whole(s.width, s.height), s.cell_size,
                                 std::numeric_limits<float>::quiet_NaN(), 0};
  require_surface(file, s.width, s.height);
  render::TerrainBlock block =
      render::build_terrain_block(grid, 0, 0, layer_windows(s), look_of_export(s.palette));
  TerrainMeshes meshes{std::move(block.ground), std::move(block.water), {}};
  if (terrain.plants) meshes.plants = plants_of(*terrain.plants, 1, false);
  return meshes;
}

std::size_t cell_of(const Snapshot& s, const render::Vertex& vertex) {
  const auto number = [&s](float place, int count) {
    return static_cast<std::size_t>(
        std::clamp(static_cast<int>(static_cast<double>(place) / s.cell_size), 0, count - 1));
  };
  return number(vertex.y, s.height) * static_cast<std::size_t>(s.width) + number(vertex.x, s.width);
}

std::vector<render::PackedColour> ground_colours(const Snapshot& s, const render::Mesh& ground) {
  std::vector<render::PackedColour> colours(
      static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height),
      render::pack(render::unknown_colour));
  for (const render::Vertex& v : ground.vertices) colours[cell_of(s, v)] = v.colour;
  return colours;
}

std::vector<render::PackedColour> surface_colours(const Snapshot& s, const render::Mesh& ground) {
  std::vector<render::PackedColour> colours = ground_colours(s, ground);
  const std::vector<float>* const depth = s.find(Layer::water);
  if (!depth) return colours;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const float d = (*depth)[i];
    if (d > render::least_water_depth)
      colours[i] = render::pack(
          mix(unpacked(colours[i]), render::water_colour(d, s.palette), render::water_opacity(d)));
  }
  return colours;
}

std::string frame_note(const Snapshot& s) {
  return "desert_sim, step " + std::to_string(s.step) + ": metres; the origin is " +
         point_text(s.origin_x, s.origin_y) + " of the terrain's frame";
}

}  // namespace desert_sim
