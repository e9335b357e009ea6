// Heaps of sand at plants that live: against the law and the list of plants, in snapshots of bands and in
// pieces; and where plants do not live, the bits that heaps had before there were such.

#include <xxhash.h>

#include <cmath>
#include <cstring>

#include "src/simulation/views/micro_relief.hpp"
#include "test/support/refusal.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

/// Flat sand on which nothing moves, under a wind.
std::string sand(const std::string& more, const std::string& boundary = "periodic") {
  return "grid: {width: 32, height: 24, cell_size: 1, origin_x: 100, origin_y: -40, boundary: " + boundary +
         "}\nterrain: [{uniform: {layer: sand, value: 1}}]\nwind: {speed: 8, direction_deg: 30, warping: "
         "false, "
         "projection: false}\nwind_shadow: {enabled: false}\nsaltation: {enabled: false}\navalanching: "
         "{enabled: false}\n" +
         more;
}
/// Bushes that come up everywhere, and of which some are wider than heaps and others narrower.
const std::string bushes =
    "vegetation: {enabled: true, canopy_shadow: false}\nspecies: [{preset: bush, sand: 1, water_use: 0, "
    "moisture_lowest: 0, light_lowest: -10, light_highest: 10, root_cover: 0, stem_cover: 1, spawn: 4, "
    "spawn_density: 0, spawn_wind: 0, growth: 0.05}]\n";
const std::string bumps_alone = "micro_relief: {ripples: false}\n";

class HeapsAtPlants : public test::OnBackend {
 protected:
  std::unique_ptr<Simulation> meadow(const std::string& more = bumps_alone,
                                     const std::string& boundary = "periodic") {
    auto world = simulation(sand(bushes + more, boundary));
    test::run(*world, 20);
    return world;
  }
  static std::shared_ptr<const Snapshot> snapshot(Simulation& world, const RowBand& band = {}) {
    return world.views().snapshot(MicroRelief::layers(), band, true);
  }
};

std::vector<float> heights_of(const Snapshot& s, const MicroReliefWindow& w) {
  return MicroRelief(s).elevations(w);
}

/// The law, once more: the widest plant of each square metre, and the highest heap.
class ExpectedHeaps {
 public:
  explicit ExpectedHeaps(const PlantList& list) : widest_(32 * 24) {
    for (const plants::PlantRecord& p : list.plants) {
      plants::PlantRecord& w = widest_[static_cast<std::size_t>(p.y) * 32 + static_cast<std::size_t>(p.x)];
      if (p.radius > w.radius) w = p;
    }
  }
  /// At metres from the corner of the terrain.
  double height(double x, double y) const {
    constexpr double r = 0.4, highest = 0.1, lee = 0.3, pi = 3.14159265358979;
    const auto point = [](double dx, double dy) {
      const double rest =
          1 - (std::pow(std::remainder(dx, 32), 2) + std::pow(std::remainder(dy, 24), 2)) / (r * r);
      return rest > 0 ? rest * rest * rest : 0;
    };
    double most = 0;
    for (const plants::PlantRecord& p : widest_) {
      if (p.radius == 0) continue;
      const double wide = std::min(double{p.radius} / r, 1.0), strength = wide * wide * (3 - 2 * wide),
                   away_x = 0.6 * r * std::cos(pi / 6), away_y = 0.6 * r * std::sin(pi / 6);
      const double dx = x - double{p.x}, dy = y - double{p.y};
      most = std::max(most, highest * strength *
                                (point(dx + away_x, dy + away_y) + lee * point(dx - away_x, dy - away_y)));
    }
    return most;
  }

 private:
  std::vector<plants::PlantRecord> widest_;
};

TEST_P(HeapsAtPlants, AreWhereTheyStandAndAsHighAsTheyAreWide) {
  const auto world = meadow();
  const auto list = world->views().begin_plants().get();
  ASSERT_GT(list->plants.size(), 40u);
  ASSERT_LT(list->plants.size(), 200u) << "else there is no bare ground";
  const auto narrower = [&](float radius) {
    return std::count_if(list->plants.begin(), list->plants.end(),
                         [radius](const plants::PlantRecord& p) { return p.radius < radius; });
  };
  EXPECT_GT(narrower(0.3f), 5);
  EXPECT_LT(narrower(0.4f), static_cast<long>(list->plants.size()) - 5);
  const ExpectedHeaps expected(*list);
  const MicroRelief micro_relief(*snapshot(*world));
  double highest = 0;
  int bare = 0, points = 0;
  for (double x = 0.015; x < 32; x += 0.17)
    for (double y = 0.015; y < 24; y += 0.17, ++points) {
      const double heap = micro_relief.offset(100 + x, -40 + y);
      ASSERT_NEAR(heap, expected.height(x, y), 1e-4) << x << " " << y;
      highest = std::max(highest, heap);
      bare += heap == 0;
    }
  EXPECT_GT(highest, 0.09);
  EXPECT_GT(bare, points / 3);
}

TEST_P(HeapsAtPlants, BandsAndPiecesHaveTheBitsOfTheWhole) {
  for (const char* boundary : {"periodic", "open"}) {
    const auto world = meadow("micro_relief: {crest_length: 0.7}\n", boundary);
    const std::shared_ptr<const Snapshot> whole = snapshot(*world);
    ASSERT_EQ(whole->feet->widest.size(), 32u * 24u);
    for (const MicroReliefWindow& w : {MicroReliefWindow{104, -31, 200, 60, 0.05},
                                       {100, -40, 64, 40, 0.07},
                                       {125, -17, 150, 90, 0.05},
                                       {98, -44, 120, 150, 0.06}}) {
      const auto part = snapshot(*world, MicroRelief::band(w, *whole));
      EXPECT_LT(part->feet->widest.size(), whole->feet->widest.size());
      const std::vector<float> a = heights_of(*whole, w), b = heights_of(*part, w);
      EXPECT_EQ(0, std::memcmp(a.data(), b.data(), a.size() * sizeof(float))) << boundary << " " << w.x0;
    }
    world->views().staging().set_slot_bytes(5 * 32 * sizeof(micro_relief::FootNumber));  // of five rows
    EXPECT_EQ(snapshot(*world)->feet->widest, whole->feet->widest);
    EXPECT_EQ(snapshot(*world, {21, 9})->feet->widest,
              snapshot(*meadow("micro_relief: {crest_length: 0.7}\n", boundary), {21, 9})->feet->widest);
  }
}

TEST_P(HeapsAtPlants, APeriodicTerrainRepeatsThem) {
  const auto world = meadow();
  const auto s = snapshot(*world);
  EXPECT_EQ(heights_of(*s, {102, -37, 60, 60, 0.05}), heights_of(*s, {102 - 32, -37 + 24, 60, 60, 0.05}));
  const MicroReliefWindow edge{130, -18, 80, 80, 0.05};
  EXPECT_EQ(heights_of(*s, edge), heights_of(*s, {98, -42, 80, 80, 0.05}));
  const MicroRelief micro_relief(*s);
  const std::vector<float> z = micro_relief.elevations(edge);
  for (int n = 0; n < 80; ++n)
    EXPECT_EQ(static_cast<float>(1 + micro_relief.offset(130 + (n + 0.5) * 0.05, -18 + 40.5 * 0.05)),
              z[static_cast<std::size_t>(40 * 80 + n)]);
}

TEST_P(HeapsAtPlants, ASnapshotWithoutThemIsRefusedOnlyWhereTheyAreNeeded) {
  const auto world = meadow(), without = meadow("micro_relief: {bumps: false}\n");
  const auto lacking = world->views().snapshot(MicroRelief::layers());
  EXPECT_FALSE(lacking->feet);
  EXPECT_NE(test::refusal([&] { MicroRelief{*lacking}; }).find("lacks the feet of plants"),
            std::string::npos);
  const auto none = snapshot(*without);
  EXPECT_FALSE(none->feet) << "nobody needs them";
  for (float z : heights_of(*none, {104, -31, 200, 60, 0.05})) ASSERT_NEAR(z, 1, 0.02);
}

/// Plants of the layer alone, and a block of stone.
const std::string still =
    "terrain: [{uniform: {layer: sand, value: 1}}, {column: {layer: vegetation, x: 110, y: -30, size_x: 12, "
    "size_y: "
    "9, height: 0.8}}, {column: {layer: obstacle, x: 125, y: -28, size_x: 3, size_y: 3, height: 1}}]\n";

TEST_P(HeapsAtPlants, WherePlantsDoNotLiveTheBitsAreThoseOfEarlierVersions) {
  std::string yaml = sand(bumps_alone);
  yaml.replace(yaml.find("terrain:"), yaml.find("wind:") - yaml.find("terrain:"), still);
  const auto world = simulation(yaml);
  const auto s = snapshot(*world), as_ever = world->views().snapshot(MicroRelief::layers());
  EXPECT_FALSE(s->feet);
  const MicroReliefWindow w{100, -40, 640, 480, 0.05};
  const std::vector<float> z = heights_of(*s, w);
  EXPECT_EQ(z, heights_of(*as_ever, w));
  EXPECT_GT(*std::max_element(z.begin(), z.end()), 1.05f);
  EXPECT_EQ(XXH3_64bits(z.data(), z.size() * sizeof(float)), 11179053078637129498u);
}

DESERT_ON_EACH_BACKEND(HeapsAtPlants);

}  // namespace
}  // namespace desert_sim
