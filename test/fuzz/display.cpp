// Messages that the plugins of rviz draw: meshes are finite, for OGRE ends a program whose meshes are not.
#include <boost/make_shared.hpp>
#include <cmath>

#include "include/desert_sim/client/layer_assembler.hpp"
#include "src/render/plant_cover.hpp"
#include "src/render/sunlight.hpp"
#include "src/render/terrain_block.hpp"
#include "src/rviz/map_windows.hpp"
#include "src/rviz/message_meshes.hpp"
#include "test/fuzz/fuzz.hpp"
#include "test/fuzz/message_source.hpp"

namespace desert_sim {
namespace {

const std::vector<std::string> words{"map", "bush", ""};

void expect_finite(const render::Mesh& mesh) {
  for (const render::Vertex& v : mesh.vertices)
    for (const float number : {v.x, v.y, v.z, v.normal_x, v.normal_y, v.normal_z})
      if (!std::isfinite(number)) std::abort();
  for (const std::uint32_t index : mesh.indices)
    if (index >= mesh.vertices.size()) std::abort();
}

/// A map of the elevation; null for one that clients refuse.
std::shared_ptr<const LayerMap> terrain(FuzzedDataProvider& data) {
  auto grid = boost::make_shared<ElevationGrid>(fuzz::next_message<ElevationGrid>(data, words));
  if (data.ConsumeBool()) {  // its size is right
    grid->width = data.ConsumeIntegralInRange(1u, 70u);
    grid->height = data.ConsumeIntegralInRange(1u, 70u);
    grid->elevation.resize(std::size_t{grid->width} * grid->height);
    grid->cell_size = data.ConsumeFloatingPointInRange(0.01, 100.0);
    grid->header.frame_id = "map";
    grid->origin = geometry_msgs::Pose();
    grid->origin.orientation.w = 1;
    grid->origin.position.x = data.PickValueInArray({0.0, -30.0, 500000.25, 1e7});
  }
  LayerAssembler assembler;
  return assembler.process(ElevationGrid::ConstPtr(grid)).map;
}

/// A map of another layer of the same terrain.
std::shared_ptr<const LayerMap> layer_on(const MapInfo& terrain, const char* name, FuzzedDataProvider& data) {
  auto grid = boost::make_shared<LayerGrid>(fuzz::next_message<LayerGrid>(data, words));
  grid->layer = name;
  grid->header.frame_id = terrain.frame;
  grid->width = terrain.width;
  grid->height = terrain.height;
  grid->cell_size = terrain.cell_size;
  grid->origin = geometry_msgs::Pose();
  grid->origin.orientation.w = 1;
  grid->origin.position.x = terrain.origin_x;
  grid->origin.position.y = terrain.origin_y;
  grid->data.resize(std::size_t{terrain.width} * terrain.height);
  LayerAssembler assembler;
  return assembler.process(LayerGrid::ConstPtr(grid)).map;
}

void draw(const std::shared_ptr<const LayerMap>& map, FuzzedDataProvider& data) {
  const MapInfo& info = map->info();
  LayerMaps maps{{"elevation", map}};
  for (const char* const name : {"water_depth", "traversability", "vegetation"})
    if (const auto layer = layer_on(info, name, data)) maps[name] = layer;
  const render::BlockLayout layout(static_cast<int>(info.width), static_cast<int>(info.height));
  const render::LayerWindow window = windows_of(maps, map);
  render::TerrainLook look;
  look.contour_interval = 0.5;
  look.overlay.layer = data.PickValueInArray({"", "cost", "water_depth", "slope", "change"});
  const render::TerrainGrid grid{layout,
                                 info.cell_size,
                                 render::base_of_walls(layout, info.cell_size, window),
                                 data.ConsumeIntegralInRange(0, render::longest_shadow),
                                 {}};
  for (int block = 0; block < layout.count(); ++block)
    for (const int level : {0, 3}) {
      const render::TerrainBlock meshes = render::build_terrain_block(grid, block, level, window, look);
      for (const render::Mesh* const mesh : {&meshes.ground, &meshes.water, &meshes.contours})
        expect_finite(*mesh);
    }
}

WindField wind(FuzzedDataProvider& data) {
  auto message = fuzz::next_message<WindField>(data, words);
  if (data.ConsumeBool()) return message;
  message.width = data.ConsumeIntegralInRange(0u, 20u);
  message.height = data.ConsumeIntegralInRange(0u, 20u);
  for (std::vector<float>* const values : {&message.u, &message.v})
    values->resize(std::size_t{message.width} * message.height, 3);
  return message;
}

Plants plants(FuzzedDataProvider& data) {
  auto message = fuzz::next_message<Plants>(data, words);
  if (data.ConsumeBool()) return message;
  const std::size_t count = message.x.size();
  for (std::vector<float>* const values : {&message.y, &message.z, &message.radius}) values->resize(count, 1);
  message.species_index.resize(count);
  message.health.resize(count, 200);
  if (message.species.empty()) message.species.resize(1);
  return message;
}

}  // namespace
}  // namespace desert_sim

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace desert_sim;
  FuzzedDataProvider data(bytes, size);
  std::shared_ptr<const LayerMap> map;
  fuzz::take_messages(data, 8, [&] {
    if (const auto next = terrain(data)) draw(map = next, data);
    if (!map) return;
    const int most = data.PickValueInArray({0, 1, 100, 4000});
    if (const auto mesh = wind_mesh(wind(data), *map, most)) expect_finite(*mesh);
    const render::PlantTiles drawn = plant_tiles(plants(data));
    const double exaggeration = data.ConsumeFloatingPointInRange(0.1, 100.0);
    for (const render::PlantTile& tile : drawn.tiles())
      expect_finite(drawn.mesh(tile, data.ConsumeBool(), exaggeration));
    if (render::plant_cover(drawn).width > render::CoverPicture::most_pixels) std::abort();
  });
  return 0;
}
