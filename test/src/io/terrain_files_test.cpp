// A terrain saved as rasters and loaded again, by Session and by what a journal replays.

#include "src/io/terrain_files.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <thread>

#include "src/core/files.hpp"
#include "src/io/raster_loader.hpp"
#include "src/simulation/session.hpp"
#include "test/support/full_disk.hpp"
#include "test/support/log_lines.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

const char* const world =
    "grid: {width: 30, height: 20, cell_size: 2, origin_x: 500, origin_y: -70, boundary: open}\n"
    "terrain: [ramp: {layer: bedrock, value: 18, slope_x: 0.7}, noise: {layer: sand, low: 0, high: 3}]\n"
    "wind: {speed: 6}\n";

class TerrainFiles : public ::testing::TestWithParam<const char*> {
 protected:
  std::unique_ptr<Session> session(const std::string& yaml, const std::string& journal = "") {
    return std::make_unique<Session>(test::parsed(yaml), gdal_raster_loader(), "cpu", 1, journal);
  }
  std::string save(Session& s, const std::string& tag) {
    Simulation& simulation = s.simulation();
    save_terrain(file_, simulation.scenario(), *simulation.views().snapshot(persistent_layers(simulation)),
                 as_geotiff() ? geotiff_writer("") : png16_writer(), tag);
    return file_;
  }
  /// The names of the files that there are.
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path(".")))
      names.insert(entry.path().filename());
    return names;
  }
  bool as_geotiff() const { return GetParam() == std::string("geotiff"); }
  double tolerance() const { return as_geotiff() ? 4e-6 : 43 / 65535.0; }

  const test::TemporaryFolder folder_;
  const std::string file_ = folder_.path("terrain.yaml");
};

TEST_P(TerrainFiles, ComeBackWithinTheFormatsRounding) {
  auto s = session(world);
  for (int n = 0; n < 5; ++n) s->step();
  save(*s, "a");
  auto other = session("grid: {width: 8, height: 9}\nterrain: []\nwind: {speed: 3, direction_deg: 90}\n");
  other->apply(command::LoadScenario{file_, true, 0});
  const Simulation& loaded = other->simulation();
  EXPECT_EQ(loaded.steps(), 0u);
  EXPECT_EQ(loaded.state().wind_above().y, 3) << "only the terrain is loaded";
  const GridParameters& grid = loaded.scenario().grid;
  EXPECT_EQ(grid.width, 30);
  EXPECT_EQ(grid.height, 20);
  EXPECT_EQ(grid.cell_size, 2);
  EXPECT_EQ(grid.origin_x, 500);
  EXPECT_EQ(grid.origin_y, -70);
  EXPECT_EQ(grid.boundary, Boundary::open);
  for (Layer layer : {Layer::bedrock, Layer::sand, Layer::airborne_sand}) {
    const std::vector<float> a = s->simulation().terrain().values(layer), b = loaded.terrain().values(layer);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
      EXPECT_NEAR(a[i], b[i], tolerance()) << info(layer).name << " " << i;
  }
  const std::uint64_t start = loaded.state().hash();
  other->step();
  other->apply(command::Reset{});
  EXPECT_EQ(other->simulation().state().hash(), start) << "a reset goes back to it";
}

/// Its highest number is 65535, and the block lies far from all others; who gives the same files without
/// saying that they are complete is warned.
TEST_P(TerrainFiles, AreKnownToMissNoData) {
  auto s = session(
      "grid: {width: 30, height: 20}\nterrain: [uniform: {layer: bedrock, value: 1}, column: {layer: "
      "bedrock, x: "
      "9, y: 9, size_x: 3, size_y: 3, height: 900}]\n");
  save(*s, "a");
  const std::string saved = read_file(file_);
  const auto warnings = [&] {
    test::LogLines log;
    session(world)->apply(command::LoadScenario{file_, true, 0});
    return std::count_if(log.lines.begin(), log.lines.end(), [](const std::string& line) {
      return line.find("stand for missing data") != std::string::npos;
    });
  };
  EXPECT_EQ(warnings(), 0);
  std::string unsaid = saved;
  for (std::size_t at; (at = unsaid.find("complete: true")) != std::string::npos;)
    unsaid.replace(at, 14, "complete: false");
  ASSERT_NE(unsaid, saved);
  folder_.write("terrain.yaml", unsaid);
  EXPECT_GT(warnings(), 0);
}

TEST_P(TerrainFiles, OfAScenarioWhoseNameHasALineBreakHaveOneComment) {
  auto s = session(world);
  s->simulation().state().scenario.name = "dunes\nseed: 77";
  save(*s, "a");
  EXPECT_EQ(load_scenario(file_).seed, s->simulation().scenario().seed);
  EXPECT_EQ(read_file(file_).find("\nseed: 77"), std::string::npos);
}

TEST_P(TerrainFiles, AreAScenarioThatRunsAsBefore) {
  auto s = session(world);
  auto same = session("grid: {width: 8, height: 9}\n");
  save(*s, "a");
  same->apply(command::LoadScenario{file_, false, 0});
  EXPECT_EQ(same->simulation().state().wind_above().x, 6);
}

TEST_P(TerrainFiles, ReplaceAnEarlierTerrainWhole) {
  auto s = session(world);
  save(*s, "a");
  s->step();
  save(*s, "b");
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path(".")))
    EXPECT_EQ(entry.path().filename().string().find("-a."), std::string::npos) << entry.path();
  session(world)->apply(command::LoadScenario{file_, true, 0});
}

/// Both writers have a terrain of their own; whoever comes last wins whole.
TEST_P(TerrainFiles, SavedToOneFolderAtTheSameTimeAreOneOfThemWhole) {
  auto a = session(world), b = session(world);
  b->step();
  std::set<std::uint64_t> allowed;
  for (Session* s : {a.get(), b.get()}) {
    save(*s, "x");
    auto loaded = session(world);
    loaded->apply(command::LoadScenario{file_, true, 0});
    allowed.insert(loaded->simulation().state().hash());
  }
  ASSERT_EQ(allowed.size(), 2u);
  for (int n = 0; n < 25; ++n) {
    std::vector<std::thread> writers;
    for (Session* s : {a.get(), b.get()})
      writers.emplace_back([&, s] { save(*s, (s == a.get() ? "a" : "b") + std::to_string(n)); });
    for (std::thread& writer : writers) writer.join();
    auto loaded = session(world);
    ASSERT_NO_THROW(loaded->apply(command::LoadScenario{file_, true, 0})) << "round " << n;
    EXPECT_EQ(allowed.count(loaded->simulation().state().hash()), 1u) << "round " << n;
    EXPECT_EQ(files().size(), load_scenario(file_).terrain.size() + 1) << "the other's files are left";
  }
}

TEST_P(TerrainFiles, ThatCannotBeWrittenLeaveAnEarlierTerrainAndNothingElse) {
  auto s = session(world);
  save(*s, "a");
  const std::set<std::string> before = files();
  s->step();
  const std::string taken = layer_file_name("sand", "b", as_geotiff() ? ".tif" : ".png");
  std::filesystem::create_directory(folder_.path(taken));
  EXPECT_THROW(save(*s, "b"), ConfigError);
  std::filesystem::remove(folder_.path(taken));
  EXPECT_EQ(files(), before) << "the layers that came before the one that failed";
  session(world)->apply(command::LoadScenario{file_, true, 0});
  {
    const test::FullDisk disk(100);
    EXPECT_THROW(save(*s, "b"), WriteError);
  }
  EXPECT_EQ(files(), before);
  session(world)->apply(command::LoadScenario{file_, true, 0});
}

TEST_P(TerrainFiles, AreNotWrittenOverALink) {
  auto s = session(world);
  folder_.write("victim", "precious");
  std::filesystem::create_symlink(folder_.path("victim"), file_);
  EXPECT_THROW(save(*s, "a"), ConfigError);
  EXPECT_EQ(read_file(folder_.path("victim")), "precious");
  EXPECT_EQ(files(), (std::set<std::string>{"terrain.yaml", "victim"}));
}

TEST_P(TerrainFiles, OfASaveThatWasKilledAreRemovedByTheNext) {
  folder_.write(".terrain-sand-a.tif.0123456789abcdef.part", "half");
  auto s = session(world);
  save(*s, "b");
  EXPECT_EQ(files().count(".terrain-sand-a.tif.0123456789abcdef.part"), 0u);
}

TEST_P(TerrainFiles, ReplayFromAJournalAndAreRefusedWhenTheyHaveChanged) {
  auto s = session(world);
  s->step();
  save(*s, "a");
  std::uint64_t hash = 0;
  {
    auto live = session(world, folder_.path("journal"));
    live->step();
    live->apply(command::LoadScenario{file_, true, 0});
    live->step();
    live->step();
    hash = live->simulation().state().hash();
  }
  const Journal journal = read_journal(folder_.path("journal"));
  ASSERT_EQ(journal.entries.size(), 1u);
  auto replay = session(world);
  replay->step();
  replay->apply(journal.entries[0].command);
  replay->step();
  replay->step();
  EXPECT_EQ(replay->simulation().state().hash(), hash);

  s->step();
  save(*s, "b");
  const std::uint64_t before = replay->simulation().state().hash();
  EXPECT_THROW(replay->apply(journal.entries[0].command), ConfigError);
  EXPECT_EQ(replay->simulation().state().hash(), before);
}

TEST_P(TerrainFiles, ThatAreBrokenAreRefusedAndTheSessionStays) {
  auto s = session(world);
  save(*s, "a");
  const std::uint64_t before = s->simulation().state().hash();
  const std::string good = read_file(file_);
  for (const std::string& bad : {std::string("grid: {width: -1}\n"), std::string("no: scenario\n"),
                                 std::string("[1"), good + "\nsand: 1\n"}) {
    folder_.write("terrain.yaml", bad);
    EXPECT_THROW(s->apply(command::LoadScenario{file_, true, 0}), ConfigError) << bad;
    EXPECT_EQ(s->simulation().state().hash(), before);
  }
  folder_.write("terrain.yaml", good);
  for (const std::string& raster : raster_paths(load_scenario(file_))) std::filesystem::remove(raster);
  EXPECT_THROW(s->apply(command::LoadScenario{file_, true, 0}), ConfigError);
  EXPECT_EQ(s->simulation().state().hash(), before);
}

const char* const garden =
    "grid: {width: 30, height: 20}\n"
    "terrain: [uniform: {layer: soil, value: 3}, uniform: {layer: sand, value: 0.2}]\n"
    "vegetation: {enabled: true}\n"
    "species: [{preset: bush, spawn: 200, moisture_lowest: 0, light_highest: 2}]\n";

/// The layer vegetation follows from the plants, and a scenario that has plants may not paint it.
TEST_P(TerrainFiles, WithLivePlantsLoadAndSayThatThePlantsAreNotSaved) {
  auto s = session(garden);
  for (int n = 0; n < 5; ++n) s->step();
  ASSERT_GT(s->simulation().state().plants.count, 0);
  save(*s, "a");
  EXPECT_NE(read_file(file_).find("# Its plants are not saved"), std::string::npos);
  auto other = session(world);
  other->apply(command::LoadScenario{file_, false, 0});
  EXPECT_EQ(other->simulation().state().plants.count, 0);
  const std::vector<float> before = s->simulation().terrain().values(Layer::humus),
                           after = other->simulation().terrain().values(Layer::humus);
  ASSERT_GT(*std::max_element(before.begin(), before.end()), 0);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(before[i], after[i], tolerance());
  for (int n = 0; n < 5; ++n) other->step();
  EXPECT_GT(other->simulation().state().plants.count, 0) << "others come up";
}

TEST_P(TerrainFiles, WithPaintedVegetationAreRefusedWherePlantsLive) {
  auto s = session("grid: {width: 8, height: 9}\nterrain: [uniform: {layer: vegetation, value: 0.5}]\n");
  save(*s, "a");
  auto plants = session(garden);
  const std::uint64_t before = plants->simulation().state().hash();
  EXPECT_THROW(plants->apply(command::LoadScenario{file_, true, 0}), ConfigError);
  EXPECT_EQ(plants->simulation().state().hash(), before);
}

INSTANTIATE_TEST_SUITE_P(Formats, TerrainFiles, ::testing::Values("geotiff", "png16"),
                         [](const auto& p) { return p.param; });

}  // namespace
}  // namespace desert_sim
