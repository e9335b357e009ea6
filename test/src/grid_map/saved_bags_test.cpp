// A terrain saved as a bag and loaded again: by its scenario, by the bag alone, by what a journal replays.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "src/grid_map/grid_map_bag.hpp"
#include "src/ros/services/terrain_formats.hpp"
#include "src/simulation/session.hpp"
#include "test/support/full_disk.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

const char* const world =
    "grid: {width: 30, height: 20, cell_size: 2, origin_x: 500, origin_y: -70, boundary: open}\n"
    "terrain: [ramp: {layer: bedrock, value: 18, slope_x: 0.7}, noise: {layer: sand, low: 0, high: 3},\n"
    "  noise: {layer: soil, low: 0, high: 1, seed: 4}, noise: {layer: vegetation, seed: 5},\n"
    "  noise: {layer: erosion_resistance, seed: 6}, noise: {layer: humus, seed: 7}]\n"
    "wind: {speed: 6}\n";
const char* const other_world = "grid: {width: 8, height: 9}\nwind: {speed: 3, direction_deg: 90}\n";

class SavedBags : public testing::Test {
 protected:
  std::unique_ptr<Session> session(const std::string& yaml, const std::string& journal = "") {
    return std::make_unique<Session>(test::parsed(yaml), raster_loader_with_bags(), "cpu", 1, journal);
  }
  void save(Session& session, const std::string& tag) {
    Simulation& s = session.simulation();
    std::vector<Layer> layers = persistent_layers(s);
    layers.push_back(Layer::elevation);
    TerrainToSave terrain;
    terrain.state.snapshot = s.views().snapshot(layers);
    terrain.scenario = s.scenario();
    save_terrain(file_, terrain.scenario, *terrain.state.snapshot,
                 layer_writer(TerrainFormat::rosbag, terrain, "map", "/desert_sim/grid_map"), tag);
    bag_ = folder_.path("terrain-grid_map-" + tag + ".bag");
  }
  void expect_same_terrain(Session& a, Session& b) {
    for (const LayerInfo& layer : layer_table) {
      if (layer.lifetime != Lifetime::persistent) continue;
      const std::vector<float> x = a.simulation().terrain().values(layer.layer),
                               y = b.simulation().terrain().values(layer.layer);
      ASSERT_EQ(x.size(), y.size());
      for (std::size_t i = 0; i < x.size(); ++i) ASSERT_NEAR(x[i], y[i], 4e-6) << layer.name << " " << i;
    }
  }

  const test::TemporaryFolder folder_;
  const std::string file_ = folder_.path("terrain.yaml");
  std::string bag_;
};

TEST_F(SavedBags, ComeBackWithEveryLayerWithinFloatsRounding) {
  auto s = session(world);
  for (int n = 0; n < 5; ++n) s->step();
  save(*s, "a");
  for (const std::string& file : {file_, bag_}) {
    SCOPED_TRACE(file);
    auto other = session(other_world);
    other->apply(command::LoadScenario{file, true, 0, false});
    expect_same_terrain(*s, *other);
    const GridParameters& grid = other->simulation().scenario().grid;
    EXPECT_EQ(grid.cell_size, 2);
    EXPECT_EQ(grid.origin_x, 500);
    EXPECT_EQ(grid.origin_y, -70);
    EXPECT_EQ(grid.boundary, Boundary::open);
    EXPECT_EQ(other->simulation().state().wind_above().y, 3) << "only the terrain is loaded";
    const std::uint64_t start = other->simulation().state().hash();
    other->step();
    other->apply(command::Reset{});
    EXPECT_EQ(other->simulation().state().hash(), start) << "a reset goes back to it";
  }
}

TEST_F(SavedBags, AreAScenarioThatRunsAsBefore) {
  auto s = session(world);
  save(*s, "a");
  auto same = session(other_world);
  same->apply(command::LoadScenario{file_, false, 0, false});
  EXPECT_EQ(same->simulation().state().wind_above().x, 6);
  expect_same_terrain(*s, *same);
}

TEST_F(SavedBags, HoldOneMapOnTheTopicOfTheNode) {
  auto s = session(world);
  save(*s, "a");
  const GridMap map = read_grid_map(bag_);
  EXPECT_EQ(map.info.header.frame_id, "map");
  EXPECT_EQ(map.layers.at(0), "elevation");
  EXPECT_EQ(map.basic_layers, std::vector<std::string>{"elevation"});
  for (const char* layer : {"bedrock", "sand_depth", "soil_depth", "airborne_sand", "vegetation", "humus"})
    EXPECT_EQ(std::count(map.layers.begin(), map.layers.end(), layer), 1) << layer;
}

TEST_F(SavedBags, ReplaceAnEarlierTerrainWhole) {
  auto s = session(world);
  save(*s, "a");
  s->step();
  save(*s, "b");
  EXPECT_FALSE(std::filesystem::exists(folder_.path("terrain-grid_map-a.bag")));
  EXPECT_TRUE(std::filesystem::exists(bag_));
}

TEST_F(SavedBags, ReplayFromAJournalAndAreRefusedWhenTheyHaveChanged) {
  auto s = session(world);
  save(*s, "a");
  std::uint64_t hash = 0;
  {
    auto live = session(world, folder_.path("journal"));
    live->step();
    live->apply(command::LoadScenario{bag_, true, 0, true});
    live->step();
    hash = live->simulation().state().hash();
  }
  const Journal journal = read_journal(folder_.path("journal"));
  ASSERT_EQ(journal.entries.size(), 1u);
  EXPECT_TRUE(std::get<command::LoadScenario>(journal.entries[0].command).fill_nodata);
  auto replay = session(world);
  replay->step();
  replay->apply(journal.entries[0].command);
  replay->step();
  EXPECT_EQ(replay->simulation().state().hash(), hash);

  GridMap map = read_grid_map(bag_);
  map.data[1].data[5] += 1;
  write_grid_map(bag_, "/map", map);
  EXPECT_THROW(replay->apply(journal.entries[0].command), ConfigError);
  EXPECT_EQ(replay->simulation().state().hash(), hash);
}

TEST_F(SavedBags, ThatCannotBeWrittenLeaveNothing) {
  EXPECT_THROW(write_grid_map(folder_.path("no/such/folder.bag"), "/map", GridMap()), ConfigError);
  std::filesystem::create_directories(folder_.path("taken.bag/full"));
  EXPECT_THROW(write_grid_map(folder_.path("taken.bag"), "/map", GridMap()), ConfigError);
  auto s = session(world);
  save(*s, "a");
  const GridMap map = read_grid_map(bag_);
  const test::TemporaryFolder full;
  for (const rlim_t bytes : {0, 1000, 8000}) {
    const test::FullDisk disk(bytes);
    EXPECT_THROW(write_grid_map(full.path("a.bag"), "/map", map), WriteError) << bytes;
  }
  EXPECT_TRUE(std::filesystem::is_empty(full.path(".")));
}

TEST_F(SavedBags, DoNotFollowLinksThatSomebodyHasPlanted) {
  folder_.write("victim", "precious");
  std::filesystem::create_symlink(folder_.path("victim"), folder_.path("a.bag.part"));
  write_grid_map(folder_.path("a.bag"), "/map", GridMap());
  EXPECT_EQ(test::file_bytes(folder_.path("victim")), "precious");
  EXPECT_TRUE(std::filesystem::is_regular_file(folder_.path("a.bag")));
}

}  // namespace
}  // namespace desert_sim
