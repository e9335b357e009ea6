// Slab models whose cells resist the wind, by plants or as packed snow, and forced erosion.

#include "kernels/slabs/resistance.hpp"

#include <cmath>

#include "kernels/slabs/slab_model.hpp"
#include "test/support/cases.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

class SlabResistance : public test::OnBackend {};
class ForcedErosion : public test::OnBackend {};

constexpr float slab = 0.1f;
constexpr int side = 48;
const std::string grid = test::grid_yaml(side, side, "periodic");
const std::string bed = "terrain:\n  - uniform: {layer: sand, value: 2}\n";

std::vector<float> metres(const Simulation& s, Layer layer) { return s.terrain().values(layer); }

/// The west half is planted: no slab leaves it, and the first that the wind brings over its edge stay there.
TEST_P(SlabResistance, WherePlantsAreFullyEffectiveNoSlabIsTakenAndEachStays) {
  auto s = simulation(grid + bed +
                      "  - column: {layer: grass, x: 12, y: 24, size_x: 24, size_y: 48, height: 0.4}\n"
                      "  - column: {layer: shrub, x: 12, y: 24, size_x: 24, size_y: 48, height: 0.6}\n"
                      "wind: {speed: 3}\nsand: {model: nield_baas}\nslab_model: {slab_height: 0.1}\n");
  test::run(*s, 2);  // so few that no slope becomes too steep
  const std::vector<float> sand = metres(*s, Layer::sand);
  double at_edge = 0, inside = 0, bare = 0;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const float now = sand[static_cast<std::size_t>(y * side + x)];
      if (x < 24) {
        EXPECT_GE(now, 2.0f - 1e-4f) << x << ", " << y;
      }
      (x < 3 ? at_edge : x < 24 ? inside : bare) += static_cast<double>(now) - 2.0;
    }
  EXPECT_GT(at_edge, 100 * slab) << "what comes lands there";
  EXPECT_NEAR(inside, 0, 1e-3) << "nothing flies on";
  EXPECT_LT(bare, -100 * slab);
  test::expect_sound(*s, "after two steps");
}

/// With R = ½ half of the polls take a slab: of a bed on which each that is taken leaves the grid.
double slabs_taken(Simulation& s) {
  const MaterialBalance sand = s.state().balance()[static_cast<int>(Material::sand)];
  return sand.cubic_metres(sand.out) / static_cast<double>(slab);
}
const std::string open_grid = test::grid_yaml(side, side, "open");
const std::string far = "wind: {speed: 40}\n";
std::string model(const std::string& name, const std::string& more = "") {
  return far + "sand: {model: " + name + "}\nslab_model: {slab_height: 0.1, hop_time: 10" + more + "}\n";
}
constexpr double slab_cells = side * side;

TEST_P(SlabResistance, OfPlantsIsTheShareOfSlabsThatStay) {
  auto s = simulation(open_grid + bed +
                      "  - uniform: {layer: grass, value: 0.9}\n"
                      "  - uniform: {layer: mesquite, value: -0.4}\n" +
                      model("nield_baas"));
  s->step();
  EXPECT_NEAR(slabs_taken(*s), 0.5 * slab_cells, 4 * std::sqrt(0.5 * slab_cells));
}

/// At the end of a year each kind has grown by its curve of the change of sand; not before.
TEST_P(SlabResistance, PlantsGrowByTheBurialOfTheYear) {
  const std::string plants =
      "  - uniform: {layer: grass, value: 0.2}\n  - uniform: {layer: shrub, value: 0.1}\n"
      "wind: {speed: 3}\nsand: {model: nield_baas}\nslab_model: {slab_height: 0.1}\n";
  struct Run {
    const char* settings;
    int steps;
    float years;
  };
  for (const Run& r : {Run{"slab_plants: {growth_time: 3}\n", 3, 1},
                       {"slab_plants: {growth_time: 3}\nrun: {time_step: 0.5}\n", 6, 1},
                       {"slab_plants: {growth_time: 3}\nrun: {time_step: 6}\n", 1, 2}}) {
    SCOPED_TRACE(r.settings);
    auto s = simulation(grid + bed + plants + r.settings);
    const std::vector<Quanta> before = test::quanta(*s, Layer::sand);
    test::run(*s, r.steps - 1);
    for (float grass : test::real(*s, Layer::grass)) ASSERT_EQ(grass, 0.2f);
    s->step();
    const std::vector<Quanta> after = test::quanta(*s, Layer::sand);
    const std::vector<float> grass = test::real(*s, Layer::grass), shrub = test::real(*s, Layer::shrub);
    const GrowthCurves& curves = s->scenario().growth_curves;
    const double quantum = s->terrain().scale().quantum();
    int buried = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const float burial = static_cast<float>((after[i] - before[i]) * quantum) / r.years;
      buried += burial > 0.05f;
      ASSERT_NEAR(grass[i], clamp(0.2f + r.years * curves.of[0].at(burial), 0, 1), 1e-5);
      ASSERT_NEAR(shrub[i], clamp(0.1f + r.years * curves.of[2].at(burial), -0.5f, 1.5f), 1e-5);
    }
    EXPECT_GT(buried, 100);
    for (Quanta left : test::quanta(*s, Layer::burial)) ASSERT_EQ(left, 0);
    test::expect_sound(*s, "after growth");
  }
}

/// Plants hold 40°: eight slabs of a tenth of the cell, where six is what bare sand holds.
TEST_P(SlabResistance, PlantsHoldSteeperSlopes) {
  for (const bool planted : {false, true}) {
    SCOPED_TRACE(planted);
    auto s = simulation(grid + "terrain:\n  - uniform: {layer: sand, value: 1}\n" +
                        std::string(planted ? "  - uniform: {layer: shrub, value: 0.35}\n" : "") +
                        "wind: {speed: 3}\nslab_plants: {growth_time: 1.0e9}\n"
                        "sand: {model: nield_baas}\nslab_model: {slab_height: 0.1}\n");
    test::run(*s, 300);
    const std::vector<float> sand = metres(*s, Layer::sand);
    float steepest = 0;
    for (std::size_t i = 0; i < sand.size(); ++i) {
      const std::size_t x = i % side, east = i - x + (x + 1) % side;
      steepest = std::max(steepest, std::abs(sand[i] - sand[east]));
    }
    if (planted)
      EXPECT_GT(steepest, 7.5f * slab);
    else
      EXPECT_LT(steepest, 7.5f * slab);
  }
}

// ---- snow

const std::string snow =
    "wind: {speed: 3}\nrun: {time_step: 86400}\nsand: {model: snow}\nslab_model: {slab_height: 0.1, "
    "poll_time: "
    "86400}\n";

/// Day after which the sand (that is, the snow) is the same for ever.
int last_day_of_motion(Simulation& s, int days) {
  int last = 0;
  std::vector<std::uint32_t> before = s.terrain().raw_words(Layer::sand);
  for (int day = 1; day <= days; ++day) {
    s.step();
    std::vector<std::uint32_t> now = s.terrain().raw_words(Layer::sand);
    if (now != before) last = day;
    before = std::move(now);
  }
  return last;
}

TEST_P(SlabResistance, SnowAtMinusTwentyDegreesPacksIn98Days) {
  auto s = simulation(grid + bed + snow);
  for (float density : test::real(*s, Layer::snow_density)) ASSERT_NEAR(density, 67.943, 1e-3);
  EXPECT_NEAR(last_day_of_motion(*s, 115), 98, 1);
  for (float density : test::real(*s, Layer::snow_density)) ASSERT_GE(density, 250.7f);
  test::expect_sound(*s, "when packed");
}

TEST_P(SlabResistance, WarmSnowPacksSooner) {
  auto s = simulation(grid + bed + snow + "slab_snow: {temperature: 0}\n");
  const int days = last_day_of_motion(*s, 80);
  EXPECT_NEAR(days, 98 * std::exp(-0.8), 2) << "the rate is e^0.8 times that at -20 degC";
}

TEST_P(SlabResistance, SnowSettlesByItsRateAndItsWarmth) {
  auto twice = simulation(grid + bed + snow + "slab_snow: {settling_rate: 5.554e-6}\n");
  EXPECT_NEAR(last_day_of_motion(*twice, 70), 49, 1);
  auto cold = simulation(grid + bed + snow + "slab_snow: {settling_warmth: 0.02}\n");
  EXPECT_NEAR(last_day_of_motion(*cold, 80), 98 * std::exp(-0.4), 2) << "at -20 degC";
}

TEST(SnowSettling, StiffensBeyondItsLooseDensity) {
  EXPECT_NEAR((slabs::SettledSnow{300, 0.046f}(120, 0.5f)), 120 * std::exp(0.5), 1e-3) << "still loose";
  const double v = 0.02, from = 200;
  EXPECT_NEAR((slabs::SettledSnow{200, static_cast<float>(v)}(200, 0.5f)),
              from + std::log(1 + v * from * 0.5) / v, 1e-2);
}

/// The law's closed form beside the equation in steps of a second.
TEST(SnowSettling, FollowsItsEquation) {
  constexpr double rate = 2.777e-6, day = 86400;
  constexpr slabs::SettledSnow settled{150, 0.046f};
  for (const double begin : {60.0, 119.0, 149.0, 180.0, 240.0}) {
    SCOPED_TRACE(begin);
    double exact = begin;
    float density = static_cast<float>(begin);
    for (int n = 0; n < 30; ++n) {
      for (int t = 0; t < 8640; ++t)
        exact += exact * rate * 10 * (exact > 150 ? std::exp(-0.046 * (exact - 150)) : 1);
      density = settled(density, static_cast<float>(rate * day));
    }
    EXPECT_NEAR(static_cast<double>(density), exact, 0.01 * exact);
    EXPECT_GT(density, static_cast<float>(begin));
  }
}

// ---- forced erosion

/// Half of the cells have sand, so that half of the polls fail.
const std::string half =
    "terrain:\n  - column: {layer: sand, x: 12, y: 24, size_x: 24, size_y: 48, height: 3}\n";

TEST_P(ForcedErosion, TakesAsManySlabsAsCellsArePolled) {
  for (const char* polling : {"repeated", "non_repeated"})
    for (const auto& [time_step, polls] : {std::pair{"1", 1.0}, {"0.3", 0.3}, {"2.5", 2.5}}) {
      SCOPED_TRACE(testing::Message() << polling << ", " << time_step);
      const std::string world = open_grid + half + "run: {time_step: " + time_step + "}\n",
                        turns = std::string(", polling: ") + polling;
      auto free = simulation(world + model("werner", turns)),
           forced = simulation(world + model("werner", turns + ", forced_erosion: true"));
      free->step();
      forced->step();
      EXPECT_NEAR(slabs_taken(*free), 0.5 * polls * slab_cells, 4 * std::sqrt(polls * slab_cells));
      EXPECT_NEAR(slabs_taken(*forced), polls * slab_cells, 1.5 * std::sqrt(polls * slab_cells));
      test::expect_sound(*forced, "with forced erosion");
    }
}

TEST_P(ForcedErosion, EndsWhereNoSandIsLeft) {
  auto s = simulation(
      open_grid + "terrain:\n  - column: {layer: sand, x: 12, y: 24, size_x: 6, size_y: 48, height: 0.2}\n" +
      model("werner", ", polling: non_repeated, forced_erosion: true"));
  s->step();
  EXPECT_NEAR(slabs_taken(*s), 2 * 6 * 48, 0.01) << "two slabs of 6 x 48 cells";
}

DESERT_ON_EACH_BACKEND(SlabResistance);
DESERT_ON_EACH_BACKEND(ForcedErosion);

}  // namespace
}  // namespace desert_sim
