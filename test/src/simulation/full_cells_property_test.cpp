// Sources that never end fill cells up to a limit, and no sum overflows: what finds no room stays outside, or
// is booked out.

#include <algorithm>
#include <cstdint>
#include <limits>

#include "src/simulation/checkpoint.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

using test::quanta;

class FullCells : public test::OnBackend {
 protected:
  /// Runs so many steps; in each all is balanced, sound and below the wall.
  std::unique_ptr<Simulation> filled(const std::string& yaml, int steps) {
    std::unique_ptr<Simulation> s = simulation(yaml);
    for (int n = 0; n < steps; ++n) {
      test::run(*s, 1);
      test::expect_sound(*s, "after step " + std::to_string(n + 1));
      EXPECT_LT(highest(*s), wall_height);
      const std::vector<Quanta> water = quanta(*s, Layer::water);
      if (!water.empty()) deepest_ = std::max(deepest_, *std::max_element(water.begin(), water.end()));
      if (testing::Test::HasFailure()) break;
    }
    return s;
  }
  Quanta deepest_ = 0;  ///< water in all steps so far

  static Quanta highest(const Simulation& s) {
    std::vector<std::int64_t> sum(static_cast<std::size_t>(s.terrain().grid().cells()));
    for (const Layer layer : {Layer::bedrock, Layer::soil, Layer::sand, Layer::water}) {
      const std::vector<Quanta> values = quanta(s, layer);
      for (std::size_t i = 0; i < values.size(); ++i) sum[i] += values[i];
    }
    return static_cast<Quanta>(std::min<std::int64_t>(*std::max_element(sum.begin(), sum.end()),
                                                      std::numeric_limits<Quanta>::max()));
  }
};

const std::string open_sand =
    "grid: {width: 24, height: 16, cell_size: 1, boundary: open}\n"
    "terrain: [{uniform: {layer: bedrock, value: 1}}, {uniform: {layer: sand, value: 1}}]\n";

TEST_P(FullCells, ASeaAroundDeepGroundFlowsIn) {
  const auto s =
      filled(open_sand + "wind: {speed: 0}\nwater: {enabled: true, sea: border, sea_level: 500}\n", 200);
  const auto water = s->state().balance()[static_cast<std::size_t>(Material::water)];
  EXPECT_GT(water.final_m3(), 480 * 24 * 16) << "it is filled to nearly 500 m";
}

/// The datum is half way up: water is deeper than walls are high above it.
TEST_P(FullCells, ASeaThatIsAsDeepAsTheTerrainIsHigh) {
  const std::string low_sand =
      "grid: {width: 24, height: 16, cell_size: 1, boundary: open}\n"
      "terrain: [{uniform: {layer: bedrock, value: -10}}, {uniform: {layer: sand, value: 1}}]\n";
  for (const std::string level : {"1000", "1e6"}) {
    const auto s = filled(
        low_sand +
            "wind: {speed: 3}\nwater: {enabled: true, sea: border, wave_strength: 0.1, most_substeps: 256, "
            "springs: [{x: 12, y: 8, radius: 6, discharge: 100000}], "
            "sea_level: " +
            level + "}\n",
        60);
    EXPECT_GT(deepest_, wall_height) << level;
    const test::TemporaryFolder folder;
    save_checkpoint(folder.path("deep"), *s);
    EXPECT_EQ(load_checkpoint(folder.path("deep"), exec())->state().hash(), s->state().hash()) << level;
  }
}

TEST_P(FullCells, SpringsRainAndTheirLedger) {
  for (const std::string source : {"springs: [{x: 6, y: 4, radius: 2, discharge: 100000}]}\n",
                                   "evaporation: 0}\nrain: {rate: 1, share_low: 1, share_high: 1}\n"}) {
    const auto s = filled(
        "grid: {width: 12, height: 9, cell_size: 1}\n"
        "terrain: [{uniform: {layer: sand, value: 1}}]\nwind: {speed: 0}\n"
        "run: {time_step: 20}\nwater: {enabled: true, " +
            source,
        60);
    EXPECT_GT(highest(*s), fill_limit / 2) << source;
    EXPECT_LE(highest(*s), fill_limit + (Quanta{1} << 20)) << source;
    const auto water = s->state().balance()[static_cast<std::size_t>(Material::water)];
    EXPECT_GT(water.out, 0) << "what found no room is booked out: " << source;
  }
}

TEST_P(FullCells, SmallCellsOfSnow) {
  filled(
      "grid: {width: 24, height: 16, cell_size: 0.06, boundary: open}\n"
      "terrain: [{uniform: {layer: sand, value: 0.1}}]\nwind: {speed: 3}\n"
      "sand: {model: snow}\nslab_model: {slab_height: 0.02, hop_time: 0.06, poll_time: 10 min}\nrun: "
      "{time_step: 60}\n"
      "water: {enabled: true, springs: [{x: 0.7, y: 0.5, radius: 0.1, discharge: 0.1}]}\n",
      150);
}

TEST_P(FullCells, SandComesInOverTheEdgesWithoutEnd) {
  for (const std::string model :
       {"saltation: {influx: 100}\n", "saltation: {influx: 100, bounce_on_sand: 0}\n",
        "sand: {model: continuum}\nsaltation: {influx: 100}\n",
        "sand: {model: desertscape_2019}\nsaltation: {influx: 100}\n",
        "saltation: {influx: 100}\nsand: {model: werner}\n",
        "saltation: {influx: 100}\nsand: {model: momiji}\n"})
    filled(open_sand + "wind: {speed: 10}\n" + model, 200);
  filled(
      "grid: {width: 24, height: 16, cell_size: 0.01, boundary: open}\n"
      "terrain: [{uniform: {layer: sand, value: 0.1}}]\nwind: {speed: 12}\nsaltation: {influx: 1}\n"
      "sand: {model: wang}\n",
      250);
}

DESERT_ON_EACH_BACKEND(FullCells);

}  // namespace
}  // namespace desert_sim
