// What every edit keeps to: books that close, rings that conserve, symmetry, the rectangle and the change
// that it reports, a journal that replays.

#include <cmath>
#include <numeric>

#include "src/simulation/session.hpp"
#include "test/support/edits.hpp"
#include "test/support/temporary_folder.hpp"

namespace desert_sim {
namespace {

using command::EditTerrain;

const char* const rough =
    ", noise: {layer: bedrock, low: 30, high: 33, scale: 3}, noise: {layer: sand, low: "
    "1.5, high: 4, scale: 2, seed: 3}, noise: {layer: soil, low: 0.5, high: 2, scale: "
    "3, seed: 4}, noise: {layer: water, low: 0.2, high: 1, scale: 3, seed: 5}, noise: {layer: moisture, "
    "low: 0.1, high: 1, scale: 3, seed: 6}";

/// Every shape with every merge on every layer.
std::vector<EditTerrain> all_edits() {
  std::vector<EditTerrain> edits;
  for (const EditTerrain& shape : test::one_of_each_shape())
    for (int merge = 0; merge < static_cast<int>(std::size(brush_merges)); ++merge)
      for (const char* layer : {"sand", "soil", "bedrock", "water", "moisture"}) {
        EditTerrain e = shape;
        e.merge = static_cast<BrushMerge>(merge);
        e.layer = layer;
        e.value = 0.37;
        if (e.layer == "bedrock" && merge > static_cast<int>(BrushMerge::sub)) e.value = 31.2;
        e.smooth_radius = 1;
        e.smooth_passes = 2;
        edits.push_back(e);
      }
  return edits;
}

std::string name_of(const EditTerrain& e) {
  return std::string(brush_shapes[static_cast<int>(e.shape)]) + " " +
         brush_merges[static_cast<int>(e.merge)] + " " + e.layer;
}

Layer layer_of(const EditTerrain& e) { return layer_by_name(e.layer); }

long long sum(const std::vector<Quanta>& values) {
  return std::accumulate(values.begin(), values.end(), 0LL);
}

class Edits : public test::OnBackend {
 protected:
  std::unique_ptr<Simulation> world(const std::string& boundary) {
    return simulation(test::edit_world(boundary, rough));
  }
};

TEST_P(Edits, AreBookedToTheQuantumAndToldCellByCell) {
  for (const char* boundary : {"periodic", "open"}) {
    auto s = world(boundary);
    int n = 0;
    for (EditTerrain e : all_edits()) {
      SCOPED_TRACE(name_of(e) + " " + boundary);
      ++n;
      e = test::shifted(e, 1.7 * (n % 7) - 3, 1.3 * (n % 5) - 2.2);  // over the borders too
      const auto before = test::quanta(*s, layer_of(e));
      const CommandResult r = s->apply(e, true);
      const auto after = test::quanta(*s, layer_of(e));
      const double quantum = s->terrain().scale().quantum();
      EXPECT_DOUBLE_EQ(r.volume_m3, static_cast<double>(sum(after) - sum(before)) * quantum * 0.25);
      EXPECT_EQ(r.moved_m3, 0);
      const int width = r.changed_cells.x1 - r.changed_cells.x0,
                height = r.changed_cells.y1 - r.changed_cells.y0;
      EXPECT_EQ(r.changes.at(0).layer, e.layer);
      EXPECT_DOUBLE_EQ(r.changes.at(0).x, 100 + 0.5 * r.changed_cells.x0);
      EXPECT_DOUBLE_EQ(r.changes.at(0).y, -50 + 0.5 * r.changed_cells.y0);
      ASSERT_EQ(r.changes.at(0).values.size(), static_cast<std::size_t>(width * height));
      for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 20; ++x) {
          const int u = x - r.changed_cells.x0, v = y - r.changed_cells.y0;
          const bool touched = u >= 0 && v >= 0 && u < width && v < height;
          const auto i = static_cast<std::size_t>(y * 20 + x);
          const float told = touched ? r.changes.at(0).values[static_cast<std::size_t>(v * width + u)] : 0;
          ASSERT_EQ(told, static_cast<float>((after[i] - before[i]) * quantum)) << x << ", " << y;
        }
      test::expect_sound(*s, name_of(e));
    }
  }
}

TEST_P(Edits, ThatConserveKeepTheSumOfTheLayer) {
  for (const char* boundary : {"periodic", "open"}) {
    int made = 0;
    for (EditTerrain e : all_edits()) {
      SCOPED_TRACE(name_of(e) + " " + boundary);
      e.conserve = true;
      e.ring_width = 1.2;
      auto s = world(boundary);
      const auto books = s->state().balance();
      const auto before = test::quanta(*s, layer_of(e));
      const CommandResult r = s->apply(e, true);
      const auto after = test::quanta(*s, layer_of(e));
      EXPECT_EQ(sum(after), sum(before));
      EXPECT_EQ(r.volume_m3, 0);
      EXPECT_NEAR(std::accumulate(r.changes.at(0).values.begin(), r.changes.at(0).values.end(), 0.0), 0,
                  1e-4);
      double rise = 0;
      for (float c : r.changes.at(0).values) rise += std::abs(c) * 0.25;
      if (before != after) ++made;
      EXPECT_LE(std::abs(r.moved_m3), rise + 1e-6);
      for (std::size_t m = 0; m < books.size(); ++m) {
        EXPECT_EQ(s->state().balance()[m].in, books[m].in) << "nothing came in";
        EXPECT_EQ(s->state().balance()[m].out, books[m].out) << "nothing went out";
      }
      test::expect_sound(*s, name_of(e));
    }
    EXPECT_GT(made, 100);
  }
}

/// The same edit, with a ring and without: inside the shape they do the same, outside only the ring changes.
TEST_P(Edits, ThatConserveChangeTheShapeAsOthersDo) {
  for (const EditTerrain& e : test::one_of_each_shape()) {
    SCOPED_TRACE(name_of(e));
    auto plain = world("periodic"), ringed = world("periodic");
    const auto before = test::quanta(*plain, Layer::sand);
    plain->apply(e);
    EditTerrain conserving = e;
    conserving.conserve = true;
    conserving.ring_width = 0.8;
    ringed->apply(conserving);
    const auto a = test::quanta(*plain, Layer::sand), b = test::quanta(*ringed, Layer::sand);
    int same = 0, ring = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (a[i] != before[i]) {
        EXPECT_EQ(a[i], b[i]) << i;
        ++same;
      } else if (b[i] != before[i]) {
        EXPECT_LT(b[i], before[i]) << "the ring gives";
        ++ring;
      }
    }
    EXPECT_GT(same, 10);
    EXPECT_GT(ring, 8);
  }
}

/// On a square world, an edit turned by a quarter changes what is turned by a quarter, to a few quanta of
/// rounding.
TEST_P(Edits, TurnWithTheirShape) {
  const std::string square =
      "grid: {width: 20, height: 20, cell_size: 0.5, origin_x: 100, origin_y: -50}\n"
      "terrain: [uniform: {layer: bedrock, value: 30}, uniform: {layer: sand, value: 2}]\n";
  for (EditTerrain e : test::one_of_each_shape()) {
    SCOPED_TRACE(name_of(e));
    auto straight = simulation(square), turned = simulation(square);
    straight->apply(e);
    turned->apply(test::quarter_turned(e, 105, -45));
    const auto a = test::quanta(*straight, Layer::sand), b = test::quanta(*turned, Layer::sand);
    int changed = 0;
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 20; ++x) {
        const Quanta here = a[static_cast<std::size_t>(y * 20 + x)];
        changed += here != 2 << 20;
        ASSERT_NEAR(here, b[static_cast<std::size_t>(x * 20 + 19 - y)], 4) << x << ", " << y;
      }
    EXPECT_GT(changed, 10);
  }
}

/// Many at random, good and bad: each is made whole or refused, and the books close.
TEST_P(Edits, AtRandomAreMadeOrRefused) {
  auto s = world("periodic");
  std::uint32_t state = 7;
  const auto below = [&](std::uint32_t n) { return (state = state * 1664525u + 1013904223u) / 65536u % n; };
  const auto edits = all_edits();
  int made = 0, refused = 0;
  for (int n = 0; n < 400; ++n) {
    EditTerrain e = test::shifted(edits[below(static_cast<std::uint32_t>(edits.size()))],
                                  0.37 * below(60) - 9, 0.41 * below(60) - 9);
    e.radius = 0.05 * below(200);
    e.radius_y = 0.05 * below(80);
    e.angle_deg = 3.0 * below(250);
    e.value += 0.5 * below(9) - 1;
    e.conserve = below(2);
    e.ring_width = 0.1 * below(30);
    e.smooth_passes = static_cast<int>(below(4));
    try {
      s->apply(e);
      ++made;
    } catch (const ConfigError&) {
      ++refused;
    }
    if (n % 40 == 0) s->step();
    test::expect_sound(*s, name_of(e));
    if (HasFailure()) return;
  }
  EXPECT_GT(made, 50);
  EXPECT_GT(refused, 50);
}

/// Half a metre of soil on flat rock, without wind or wear.
const char* const soil_world =
    "grid: {width: 24, height: 20, cell_size: 0.5, origin_x: 100, origin_y: -50}\n"
    "terrain: [uniform: {layer: bedrock, value: 30}, uniform: {layer: soil, value: 0.5}]\nwind: {speed: 0}\n";

EditTerrain soil_column() {
  EditTerrain e = test::edit_at(12, 10, BrushShape::circle);
  e.layer = "soil";
  e.radius = 1.6;
  e.inner = 1;
  e.value = 3;
  return e;
}

/// The largest drop of the soil's surface between neighbours, as a tangent.
double steepest_soil(const Simulation& s) {
  const auto soil = test::quanta(s, Layer::soil), rock = test::quanta(s, Layer::bedrock);
  const Grid& grid = s.terrain().grid();
  double steepest = 0;
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x)
      for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}}) {
        const auto i = static_cast<std::size_t>(grid.index(x, y)),
                   j = static_cast<std::size_t>(neighbour_index(grid, x + dx, y + dy));
        const double drop = std::abs(static_cast<double>(soil[i] + rock[i]) - (soil[j] + rock[j]));
        steepest = std::max(steepest, drop * s.terrain().scale().quantum() / 0.5);
      }
  return steepest;
}

TEST_P(Edits, OfSoilTooSteepSlideAndComeToRest) {
  auto s = simulation(soil_world);
  s->apply(soil_column());
  const auto before = test::quanta(*s, Layer::soil);
  ASSERT_GT(steepest_soil(*s), 5);
  test::run(*s, 600);
  const auto after = test::quanta(*s, Layer::soil);
  EXPECT_LT(steepest_soil(*s), 1.02) << "soil rests at 45 degrees";
  EXPECT_EQ(sum(after), sum(before));
  test::run(*s, 1);
  EXPECT_TRUE(test::quanta(*s, Layer::soil) == after) << "it rests";
  test::expect_sound(*s, "soil");
}

TEST_P(Edits, OfTheRockBelowLetSoilSlide) {
  auto s = simulation(soil_world);
  EditTerrain pit = soil_column();
  pit.layer = "bedrock";
  pit.merge = BrushMerge::sub;
  pit.value = 1;  // of 63 degrees: too steep for soil, not for rock
  s->apply(pit);
  const auto rock = test::quanta(*s, Layer::bedrock);
  ASSERT_GT(steepest_soil(*s), 1.5);
  test::run(*s, 300);
  EXPECT_TRUE(test::quanta(*s, Layer::bedrock) == rock);
  EXPECT_LT(test::quanta(*s, Layer::soil)[12 + 10 * 24 - 4], 1 << 19) << "soil beside the pit slid into it";
}

TEST_P(Edits, OfSoilStayWhereSoilDoesNotSlide) {
  for (const char* off : {"avalanching: {soil: false}\n", "avalanching: {enabled: false}\n"}) {
    auto s = simulation(soil_world + std::string(off));
    s->apply(soil_column());
    const auto before = test::quanta(*s, Layer::soil);
    test::run(*s, 5);
    EXPECT_TRUE(test::quanta(*s, Layer::soil) == before) << off;
  }
  auto s = simulation(soil_world);
  s->apply(test::edit_at(12, 10, BrushShape::circle));  // of sand
  const auto before = test::quanta(*s, Layer::soil);
  test::run(*s, 5);
  EXPECT_TRUE(test::quanta(*s, Layer::soil) == before);
}

TEST_P(Edits, OfSoilSlideOnAfterACheckpoint) {
  const test::TemporaryFolder folder;
  Session live(test::scenario_of(soil_world), no_raster_loader, GetParam(), 1),
      resumed(test::scenario_of(soil_world), no_raster_loader, GetParam(), 1);
  live.apply(soil_column());
  for (int n = 0; n < 5; ++n) live.step();
  live.save_checkpoint(folder.path("c"));
  resumed.apply(command::LoadCheckpoint{folder.path("c"), 0});
  for (int n = 0; n < 20; ++n) live.step(), resumed.step();
  EXPECT_EQ(resumed.simulation().state().hash(), live.simulation().state().hash());
}

/// A layer that is painted in an empty terrain is the layer that a scenario begins with: every process reads
/// it, from the next step on. Undone, it is as if it had never been.
TEST_P(Edits, OfPaintedLayersAreWhatAScenarioWithTheLayerHas) {
  const std::string bare =
      "grid: {width: 40, height: 32}\nterrain: [noise: {layer: bedrock, low: 0, high: 3, scale: 6}, noise: "
      "{layer: sand, low: -1, high: 1}";
  const std::string wind = "]\nwind: {speed: 8}\nabrasion: {rate: 0.05}\n";
  for (const char* layer : {"vegetation", "erosion_resistance", "obstacle"}) {
    SCOPED_TRACE(layer);
    const auto without = simulation(bare + wind), painted = simulation(bare + wind),
               with = simulation(bare + ", uniform: {layer: " + layer + ", value: 0.625}" + wind);
    EditTerrain edit;
    edit.layer = layer;
    edit.shape = BrushShape::rectangle;
    edit.merge = BrushMerge::replace;
    edit.x = 20, edit.y = 16, edit.radius = 20, edit.radius_y = 16, edit.inner = 1;
    edit.value = 0.625;
    test::run(*without, 3);
    painted->commands().history().set_memory(default_undo_memory);
    const std::uint64_t start = painted->state().hash();
    const CommandResult result = painted->apply(edit, true);
    EXPECT_EQ(result.volume_m3, 0);
    ASSERT_EQ(result.changes.size(), 1u);
    EXPECT_EQ(result.changes[0].values, std::vector<float>(40 * 32, 0.625f));
    EXPECT_EQ(painted->state().hash(), with->state().hash());
    painted->apply(command::Undo{});
    EXPECT_EQ(painted->state().hash(), start);
    painted->apply(command::Redo{});
    test::run(*painted, 3);
    test::run(*with, 3);
    EXPECT_EQ(painted->state().hash(), with->state().hash());
    EXPECT_NE(painted->state().hash(), without->state().hash()) << "the layer has an effect";
  }
}

/// Layers that are no material have ranges of their own.
TEST_P(Edits, OfNumbersKeepToTheRangeOfTheirLayer) {
  const std::string ground = "grid: {width: 24, height: 20}\nterrain: [uniform: {layer: sand, value: 2}]\n";
  const auto meadow = simulation(ground + "sand: {model: nield_baas}\n"),
             snow = simulation(ground + "sand: {model: snow}\n");
  EditTerrain edit;
  edit.shape = BrushShape::rectangle;
  edit.x = 12, edit.y = 10, edit.radius = 12, edit.radius_y = 10, edit.inner = 1;
  const auto painted = [&](Simulation& s, const char* layer, BrushMerge merge, double value) {
    edit.layer = layer, edit.merge = merge, edit.value = value;
    s.apply(edit);
    return s.terrain().values(layer_by_name(layer)).at(200);
  };
  EXPECT_EQ(painted(*meadow, "mesquite", BrushMerge::replace, -0.5), -0.5f);
  EXPECT_EQ(painted(*meadow, "mesquite", BrushMerge::add, 4), 3) << "it has no more than 3";
  EXPECT_EQ(painted(*meadow, "shrub", BrushMerge::sub, 2), -0.5f);
  EXPECT_EQ(painted(*snow, "snow_density", BrushMerge::replace, 400.25), 400.25f);
  EXPECT_EQ(painted(*snow, "snow_density", BrushMerge::replace, 917), 917);
  edit.layer = "mesquite", edit.value = 3.5;
  EXPECT_NE(test::refusal(*meadow, edit).find("3.5 is not a value of mesquite (allowed: [-1, 3])"),
            std::string::npos);
  edit.merge = BrushMerge::add, edit.value = 5;
  EXPECT_NE(test::refusal(*meadow, edit).find("(allowed: [0, 4])"), std::string::npos);
  edit.layer = "snow_density", edit.value = 1;
  EXPECT_NE(test::refusal(*meadow, edit).find("with sand.model snow"), std::string::npos);
}

/// Counted in quanta, but in no account: plants make it, and soil uses it up.
TEST_P(Edits, OfHumusAreUndoneBetweenThoseOfPlants) {
  const auto s = simulation(
      "grid: {width: 24, height: 20}\nterrain: [uniform: {layer: soil, value: 2}]\n"
      "vegetation: {enabled: true}\nspecies: [{preset: bush, spawn: 0}]\n");
  s->commands().history().set_memory(default_undo_memory);
  test::run(*s, 2);
  EditTerrain humus;
  humus.layer = "humus", humus.merge = BrushMerge::replace;
  humus.x = 12, humus.y = 10, humus.radius = 6, humus.inner = 1, humus.value = 0.05;
  command::EditPlants bush;
  bush.species = "bush";
  bush.x = 12, bush.y = 10, bush.radius = 5, bush.density = 0.5, bush.size = 0.3;
  std::vector<std::uint64_t> hashes{s->state().hash()};
  const auto note = [&](const Command& c) {
    s->apply(c);
    hashes.push_back(s->state().hash());
    EXPECT_NE(hashes.back(), hashes[hashes.size() - 2]);
  };
  note(bush);
  note(humus);
  const float quantum = s->terrain().scale().quantum();
  EXPECT_NEAR(s->terrain().values(Layer::humus).at(10 * 24 + 12), 0.05, quantum);
  bush.seed = 4;
  note(bush);
  humus.x = 15, humus.value = 0.02;
  note(humus);
  for (std::size_t n = hashes.size() - 1; n-- > 0;) {
    s->apply(command::Undo{});
    EXPECT_EQ(s->state().hash(), hashes[n]) << n;
  }
  for (std::size_t n = 1; n < hashes.size(); ++n) {
    s->apply(command::Redo{});
    EXPECT_EQ(s->state().hash(), hashes[n]) << n;
  }
  test::run(*s, 2);
  test::expect_sound(*s, "with humus painted");
  humus.conserve = true;
  EXPECT_NE(test::refusal(*s, humus).find("humus is no material"), std::string::npos);
}

TEST_P(Edits, OfSandInTheAirAreSandAndFall) {
  const auto s = simulation("grid: {width: 24, height: 20}\nterrain: [uniform: {layer: sand, value: 1}]\n");
  s->commands().history().set_memory(default_undo_memory);
  const std::uint64_t start = s->state().hash();
  const auto sand = [&] { return s->state().balance()[static_cast<int>(Material::sand)]; };
  const double before = sand().final_m3();
  EditTerrain air;
  air.layer = "airborne_sand";
  air.x = 12, air.y = 10, air.radius = 4, air.inner = 1, air.value = 0.5;
  const CommandResult result = s->apply(air, true);
  EXPECT_NEAR(result.volume_m3, sand().final_m3() - before, 1e-9);
  EXPECT_GT(result.volume_m3, 20);
  EXPECT_EQ(sand().residual(), 0);
  EditTerrain ground = air;
  ground.layer = "sand", ground.stroke = air.stroke = "both";
  s->apply(ground);
  s->apply(air);
  const CommandResult undone = s->apply(command::Undo{"both"});
  EXPECT_NEAR(undone.returned.materials[static_cast<int>(Material::sand)]->removed_m3, 2 * result.volume_m3,
              1e-6)
      << "of both layers";
  s->apply(command::Undo{});
  EXPECT_EQ(s->state().hash(), start);
  s->apply(command::Redo{});
  s->apply(command::SetWind{0, 0, 0});
  test::run(*s, 10);
  test::expect_sound(*s, "after it fell");
  EXPECT_GT(s->terrain().values(Layer::sand).at(10 * 24 + 12), 1.3f) << "it has come down";
  const auto slabs = simulation("grid: {width: 24, height: 20}\nsand: {model: werner}\n");
  EXPECT_NE(test::refusal(*slabs, air).find("nothing carries sand through the air"), std::string::npos);
}

TEST_P(Edits, OfVegetationAreRefusedWherePlantsLive) {
  const auto s =
      simulation(test::edit_world("open") + "vegetation: {enabled: true}\nspecies: [{preset: bush}]\n");
  EditTerrain edit = test::edit_at(8, 8, BrushShape::circle);
  edit.layer = "vegetation";
  EXPECT_NE(test::refusal(*s, edit).find("edit_plants plants and clears them"), std::string::npos);
  edit.layer = "moisture";
  EXPECT_FALSE(s->terrain().has(Layer::moisture));
  EXPECT_NE(test::refusal(*s, edit).find("with moisture.enabled"), std::string::npos);
}

TEST_P(Edits, ReplayFromTheirJournalToTheSameHash) {
  const test::TemporaryFolder folder;
  const Scenario scenario = test::scenario_of(test::edit_world("periodic", rough));
  std::uint64_t hash = 0;
  {
    Session live(scenario, no_raster_loader, GetParam(), 1, folder.path("j"));
    int n = 0;
    for (EditTerrain e : all_edits()) {
      e.conserve = ++n % 3 == 0;
      live.apply(test::shifted(e, n / 3.0, -n / 7.0));
      if (n % 10 == 0) live.step();
    }
    hash = live.simulation().state().hash();
  }
  const Journal journal = read_journal(folder.path("j"));
  ASSERT_EQ(journal.entries.size(), all_edits().size());
  Session again(scenario, no_raster_loader, GetParam(), 1);
  for (const Journal::Entry& entry : journal.entries) {
    while (again.ticks() < entry.tick) again.step();
    again.apply(entry.command);
  }
  while (again.ticks() < journal.ticks) again.step();
  EXPECT_EQ(again.simulation().state().hash(), hash);
}

TEST_P(Edits, WithABrokenShapeInTheirJournalAreRefused) {
  const test::TemporaryFolder folder;
  {
    JournalWriter writer(folder.path("j"), 5, "cpu");
    writer.write(1, test::one_of_each_shape().back());
    writer.end(2);
  }
  const std::string journal = test::file_bytes(folder.path("j"));
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = journal;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from << " in " << journal;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
  };
  const std::size_t values = journal.find("patch: \"") + 8;
  std::string one_less = journal, foreign = journal;
  one_less.erase(values, 4);
  foreign[values + 5] = '*';
  for (const std::string& text :
       {one_less, foreign, replaced("patch_columns: 5", "patch_columns: 4"),
        replaced("patch_columns: 5", "patch_columns: -5"), replaced("patch_rows: 3", "patch_rows: 900000000"),
        replaced("patch_rows: 3", "patch_rows: many"), replaced("patch: \"", "patch: [\""),
        replaced("angle_deg", "points: [1, 2, 3], angle_deg"), replaced("angle_deg", "points: 7, angle_deg"),
        replaced("angle_deg", "points: [1, here], angle_deg")}) {
    try {
      read_journal(folder.write("bad", text));
      ADD_FAILURE() << "was read: " << text;
    } catch (const ConfigError& e) {
      EXPECT_NE(std::string(e.what()).find("line 2"), std::string::npos) << e.what();
    }
  }
  EXPECT_NO_THROW(read_journal(folder.path("j")));
}

DESERT_ON_EACH_BACKEND(Edits);

}  // namespace
}  // namespace desert_sim
