// Parameters that change while a simulation runs: each of them, in the middle of a run.

#include <algorithm>

#include "src/scenario/live_parameters.hpp"
#include "src/scenario/yaml_parameters.hpp"
#include "src/simulation/checkpoint.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

const std::string world =
    "grid: {width: 40, height: 30, boundary: open}\n"
    "terrain: [noise: {layer: bedrock, low: 0, high: 5, scale: 15}, noise: {layer: sand, low: 0, high: 3},\n"
    "          obstacle: {shape: cylinder, x: 20, y: 15, size_x: 4, height: 4}]\n"
    "wind: {speed: 6, direction_deg: 20}\n";

/// Another value than it has, as a setting.
template <class T>
std::string other_value(const ParameterRow& row, const T& value) {
  std::ostringstream text;
  if constexpr (std::is_same_v<T, bool>) {
    text << (value ? "false" : "true");
  } else if constexpr (std::is_same_v<T, Choice>) {
    text << row.choices[(value.number + 1) % row.choice_count];
  } else if constexpr (is_optional_number<T>) {
    text << row.lowest;
  } else if constexpr (std::is_same_v<T, ShortList>) {
    text << "[";
    for (int n = 0; n < value.count; ++n) text << (n ? ", " : "") << 0.9 * value.values[n];
    text << "]";
  } else if constexpr (std::is_same_v<T, std::string>) {
    text << "other";  // there is none yet
  } else if constexpr (std::is_floating_point_v<T>) {
    const double near = 0.9 * static_cast<double>(value);
    text << (value != 0 && near >= row.lowest ? near
                                              : row.lowest + 0.01 * std::min(1.0, row.highest - row.lowest));
  } else {
    text << (static_cast<double>(value) + 1 <= row.highest ? value + 1 : value - 1);
  }
  return text.str();
}

/// "section.key=value" of all that can change.
std::vector<std::string> all_changes(const Scenario& scenario) {
  std::vector<std::string> changes;
  for_each_live_parameter(scenario, [&](const std::string& section, const auto& row, const auto& value) {
    const std::string path = section + "." + row.name;
    if (path == "wind.regime" || path == "vegetation.enabled") return;  // need segments, species
    changes.push_back(path + "=" + other_value(row, value));
  });
  return changes;
}

class LiveParameters : public test::OnBackend {};

TEST_P(LiveParameters, EachCanChangeInTheMiddleOfARun) {
  const auto s = simulation(world);
  test::run(*s, 2);
  const std::vector<std::string> changes = all_changes(s->scenario());
  ASSERT_GT(changes.size(), 40u);
  for (const std::string& change : changes) {
    const std::string before = dump_scenario(s->state().present_scenario());
    ASSERT_NO_THROW(s->apply(command::SetParameters{{change}})) << change;
    EXPECT_NE(dump_scenario(s->state().present_scenario()), before) << change;
    test::run(*s, 1);
    test::expect_sound(*s, change);
  }
}

TEST_P(LiveParameters, ACheckpointAfterwardsContinuesToTheBit) {
  const test::TemporaryFolder folder;
  const auto s = simulation(world);
  test::run(*s, 3);
  s->apply(command::SetParameters{{"echo_dunes.enabled=true", "wind_shadow.enabled=false",
                                   "abrasion.rate=0.02", "wind.coarsening=1", "avalanching.scheme=sweeps",
                                   "wind.speed=8", "wind.ramp=4"}});
  test::run(*s, 1);
  save_checkpoint(folder.path("c"), *s);
  const auto loaded = load_checkpoint(folder.path("c"), exec());
  test::run(*s, 4);
  test::run(*loaded, 4);
  EXPECT_EQ(s->state().hash(), loaded->state().hash());
  EXPECT_EQ(dump_scenario(s->state().present_scenario()), dump_scenario(loaded->state().present_scenario()));
}

TEST_P(LiveParameters, AreTheSameAsAScenarioOfThem) {
  const auto changed = simulation(world);
  changed->apply(
      command::SetParameters{{"saltation.lift=0.2", "echo_dunes.enabled=true", "wind_shadow.enabled=false"}});
  const auto started = simulation(world +
                                  "saltation: {lift: 0.2}\necho_dunes: {enabled: true}\n"
                                  "wind_shadow: {enabled: false}\n");
  test::run(*changed, 5);
  test::run(*started, 5);
  EXPECT_EQ(changed->state().hash(), started->state().hash());
  EXPECT_FALSE(changed->terrain().has(Layer::wind_shadow)) << "a shadow that nobody casts any more";
}

TEST_P(LiveParameters, TheWindThatBlowsIsWhatChanges) {
  const auto s = simulation(world);
  s->apply(command::SetWind{90, 7, 0});
  s->apply(command::SetParameters{{"wind.speed=3"}});
  EXPECT_NEAR(s->state().wind_above().x, 0, 1e-6);
  EXPECT_NEAR(s->state().wind_above().y, 3, 1e-6);
  s->apply(command::SetParameters{{"saltation.lift=0.2"}});
  EXPECT_NEAR(s->state().wind_above().y, 3, 1e-6) << "the wind is left as it is";
}

/// The device counts them while steps converge.
TEST_P(LiveParameters, SweepsThatWereCountedAreKept) {
  const auto s = simulation(world + "avalanching: {quality: converged}\n");
  test::run(*s, 20);
  const double before = s->pipeline().mean_count(avalanche_iterations);
  EXPECT_GE(before, 12);  // of a cycle
  for (const char* change :
       {"saltation.lift=0.5", "avalanching.tolerance=0.002", "avalanching.quality=fast"}) {
    s->apply(command::SetParameters{{change}});
    EXPECT_EQ(s->pipeline().mean_count(avalanche_iterations), before) << change;
  }
  s->step();
  EXPECT_NEAR(s->pipeline().mean_count(avalanche_iterations), (20 * before + 8) / 21, 1e-9);
}

TEST_P(LiveParameters, RefusedChangesChangeNothing) {
  const auto s = simulation(world);
  test::run(*s, 2);
  const std::string before = dump_scenario(s->state().present_scenario());
  const std::uint64_t hash = s->state().hash();
  const auto expect_refused = [&](std::vector<std::string> settings, const std::string& text) {
    try {
      s->apply(command::SetParameters{std::move(settings)});
      ADD_FAILURE() << "taken: " << text;
    } catch (const ConfigError& e) {
      EXPECT_NE(std::string(e.what()).find(text), std::string::npos) << e.what();
    }
    EXPECT_EQ(dump_scenario(s->state().present_scenario()), before);
    EXPECT_EQ(s->state().hash(), hash);
  };
  expect_refused({"saltation.lift=0.2", "saltation.influx=-1"},
                 "saltation.influx: -1 is not in [0, 100] m^2/s");
  expect_refused({"saltation.lift=.nan"}, "saltation.lift: .nan");
  expect_refused({"saltation.lift={a: 1}"}, "saltation.lift: a map is not a number");
  expect_refused({"saltation.left=1"}, "saltation.left: unknown parameter");
  expect_refused({"saltation"}, "saltation: unknown parameter");
  expect_refused({""}, "unknown parameter");
  expect_refused({"wind.speed"}, "must be path=value");
  expect_refused({"wind.regime=rose"}, "wind.segments");
  expect_refused({"grid.width=30", "run.steps=2"}, "run.steps: cannot change");
  expect_refused({"terrain.0.noise.high=9"}, "terrain.0.noise.high: cannot change");
  expect_refused({"wind.segments=[]"}, "wind.segments: cannot change");
  expect_refused({"echo_dunes.sticky_reach=20", "echo_dunes.highest=500", "wind_shadow.distance=1000",
                  "wind.speed=100", "wind.speedup_highest=10", "grid.cell_size=0.01"},
                 "grid.cell_size: cannot change");
}

TEST_P(LiveParameters, ASeaThatHeightsCannotReachIsRefused) {
  auto s = simulation("grid: {width: 8, height: 8}\n");
  const auto flood = [&](const char* level) {
    s->apply(command::SetParameters{{level, "water.sea=everywhere", "water.enabled=true"}});
  };
  const std::uint64_t before = s->state().hash();
  try {
    flood("water.sea_level=5000");
    ADD_FAILURE() << "was not refused";
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("water.sea_level: 5000"), std::string::npos) << e.what();
  }
  EXPECT_EQ(s->state().hash(), before);
  flood("water.sea_level=-5000");
  test::run(*s, 1);
  EXPECT_EQ(s->state().balance()[static_cast<std::size_t>(Material::water)].in, 0);
  flood("water.sea_level=5");
  test::run(*s, 1);
  EXPECT_GT(s->state().balance()[static_cast<std::size_t>(Material::water)].in, 0);
}

DESERT_ON_EACH_BACKEND(LiveParameters);

}  // namespace
}  // namespace desert_sim
