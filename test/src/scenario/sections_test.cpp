// Dumping and parsing give every parameter back to the bit, at its limits too; the page of parameters is up
// to date.

#include "src/scenario/sections.hpp"

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <random>

#include "kernels/sand/saltation.hpp"
#include "kernels/wind/echo_dunes.hpp"
#include "kernels/wind/wind_shadow_parameters.hpp"
#include "src/scenario/scenario.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

/// Sets every number of a table: share 0 = lowest, 1 = highest, else between (whole where it must be).
struct SetAll {
  const std::function<double()>& share;

  void operator()(const ParameterRow& row, ParameterValue value) const {
    std::visit([&](auto* at) { set(row, *at); }, value);
  }

 private:
  template <class T>
  void set(const ParameterRow& row, T& value) const {
    const double number = row.lowest + share() * (row.highest - row.lowest);
    if constexpr (std::is_same_v<T, bool>) {
      value = number > 0.5;
    } else if constexpr (std::is_same_v<T, std::string>) {
    } else if constexpr (std::is_same_v<T, Choice>) {
      value.number = static_cast<int>(number);
    } else if constexpr (std::is_same_v<T, ShortList>) {
      value.count = 3;
      for (int n = 0; n < 3; ++n)
        value.values[n] = static_cast<float>(row.lowest + share() * (row.highest - row.lowest));
    } else if constexpr (is_optional_number<T>) {
      const double s = share();  // the range itself may be wider than the largest number
      value = row.lowest * (1 - s) + row.highest * s;
    } else if constexpr (std::is_same_v<T, std::uint64_t>) {
      value = number < 0x1p64 ? static_cast<T>(number) : ~T{0};  // the highest is not a double
    } else {
      value = static_cast<T>(number);
    }
  }
};

template <class P>
void set_all(P& parameters, const std::function<double()>& share) {
  visit_parameters(parameters, SetAll{share});
}

Scenario scenario_at(const std::function<double()>& share) {
  Scenario s;
  set_all(s.grid, share);
  for (Section* section : s.sections.all()) section->visit(ParameterVisit(SetAll{share}));
  set_all(s.wind, share);
  set_all(s.wind_regime, share);
  s.wind_regime.series_file = "wind.csv";  // which the last of the regimes needs
  s.wind_segments.resize(2);
  for (WindSegment& segment : s.wind_segments) set_all(segment, share);
  s.wind_features.resize(3);
  for (WindFeature& feature : s.wind_features) set_all(feature, share);
  s.species.resize(3);
  for (std::size_t n = 0; n < s.species.size(); ++n) {
    Species& species = s.species[n];
    species.name = "kind " + std::to_string(n) + ": \"a\"";
    set_all(species.traits, share);
    set_all(species.appearance, share);
    species.traits.max_radius =
        std::min(species.traits.max_radius, s.get<VegetationParameters>().largest_plant);
    species.traits.moisture_lowest =
        std::min(species.traits.moisture_lowest, species.traits.moisture_highest);
    float &low = species.traits.light_lowest, &high = species.traits.light_highest;
    if (!(low < high)) low = -10, high = std::max(high, -9.5f);
  }
  s.growth_curves = test::scenario_of("{}").growth_curves;
  for (int n = 0; n < 9; ++n) s.competition.push_back(static_cast<float>(share() * max_competition));
  const auto step = [&](auto one) {
    set_all(one, share);
    s.terrain.push_back(one);
  };
  step(UniformStep{}), step(NoiseStep{}), step(RampStep{}), step(ConeStep{}), step(ColumnStep{}),
      step(DiscsStep{});
  step(ObstacleStep{}), step(RasterStep{});
  // What the loader asks of several keys together:
  s.get<WindShadowParameters>().start_deg =
      std::min(s.get<WindShadowParameters>().start_deg, s.get<WindShadowParameters>().full_deg);
  s.get<EchoDuneParameters>().erosion_reach =
      std::min(s.get<EchoDuneParameters>().erosion_reach, s.get<EchoDuneParameters>().sticky_reach);
  for (WindSegment& segment : s.wind_segments) {
    segment.ramp = std::min(segment.ramp, segment.duration);
    segment.probability = std::max(segment.probability, 1e-30f);
  }
  s.wind.weights.values[0] = std::max(s.wind.weights.values[0], 1e-30f);
  const double most_influx =
      99.0 * static_cast<double>(s.grid.cell_size) / static_cast<double>(s.run.time_step);
  s.get<SaltationParameters>().influx =
      std::min(s.get<SaltationParameters>().influx, static_cast<float>(most_influx));
  WindFeature& on_path = s.wind_features[2];
  on_path.x = on_path.y = on_path.velocity_x = on_path.velocity_y = 0;
  on_path.path.resize(3);
  for (WindPathPoint& point : on_path.path) set_all(point, share);
  for (std::size_t n = 0; n < on_path.path.size(); ++n)
    on_path.path[n].time = (static_cast<double>(n) + 0.9 * share()) * 1e11;
  for (WindFeature& feature : s.wind_features)
    if (!ends_after_begin(feature)) feature.begin = std::min(feature.begin, 0.5 * feature.end);
  s.wind_features[1].id = std::max(s.wind_features[0].id - 1, 0);
  s.wind_features[2].id = std::max(s.wind_features[1].id - 1, 0);
  auto& discs = std::get<DiscsStep>(s.terrain[5]);
  discs.radius_low = std::min(discs.radius_low, discs.radius_high);
  return s;
}

void expect_round_trip(const Scenario& s) {
  const std::string text = dump_scenario(s);
  try {
    const std::string again = dump_scenario(test::parsed(text));
    EXPECT_EQ(text, again);
  } catch (const ConfigError& e) {
    ADD_FAILURE() << "a scenario does not read its own dump:\n" << e.what();
  }
}

TEST(ScenarioRoundTrip, OfDefaults) { expect_round_trip(Scenario{test::scenario_of("{}")}); }
TEST(ScenarioRoundTrip, AtTheLowestOfEveryRange) {
  expect_round_trip(scenario_at([] { return 0.0; }));
}
TEST(ScenarioRoundTrip, AtTheHighestOfEveryRange) {
  expect_round_trip(scenario_at([] { return 1.0; }));
}

TEST(ScenarioRoundTrip, AnywhereInEveryRange) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int n = 0; n < 50; ++n) expect_round_trip(scenario_at([&] { return uniform(random); }));
}

TEST(ScenarioRoundTrip, OfTextsThatYamlCouldMistake) {
  Scenario s = test::scenario_of("{}");
  for (const char* text : {"", "true", "12", "~", "a: b", "#x", "- y", "\"q\"", "back\\slash", "tab\there",
                           "new\nline", "äöü", "{x}", "null"}) {
    RasterStep raster;
    raster.file = text;
    s.terrain = {raster};
    s.grid.from_raster = text;
    const Scenario again = test::parsed(dump_scenario(s));
    EXPECT_EQ(std::get<RasterStep>(again.terrain[0]).file, text);
    EXPECT_EQ(again.grid.from_raster, text);
  }
}

TEST(ScenarioRoundTrip, OfEverySeedThatFits) {
  for (std::uint64_t seed : {0ULL, 1ULL, (1ULL << 53) + 1, 17999999999999999999ULL}) {
    Scenario s = test::scenario_of("{}");
    s.seed = seed;
    EXPECT_EQ(test::parsed(dump_scenario(s)).seed, seed);
  }
}

TEST(ScenarioRoundTrip, ExtremeValuesThatTheLoaderTakesSurviveToo) {
  for (const char* yaml :
       {"avalanching: {tolerance: 1e-6}", "run: {time_step: 1e-4}", "wind: {features: [{life_time: 0.01}]}",
        "repose: {moisture_capacity: 0.001}", "wind: {hold_time: 1e-3}", "grid: {cell_size: 1e-3}",
        "avalanching: {coarsest_cell: 0}", "avalanching: {transfer: 0.05}",
        "wind: {features: [{radius: 0.1}]}"})
    expect_round_trip(test::scenario_of(yaml));
}

TEST(ParameterTables, HaveRangesThatHoldTheirDefaultsAndDocumentation) {
  Scenario s;
  const auto check_row = [](const std::string& section) -> ConstParameterVisit {
    return [section](const ParameterRow& row, ConstParameterValue given) {
      EXPECT_TRUE(row.name && row.name[0]) << section;
      EXPECT_TRUE(row.doc && row.doc[0]) << section << "." << row.name;
      EXPECT_LE(row.lowest, row.highest) << section << "." << row.name;
      std::visit(
          [&](const auto* value) {
            using T = std::decay_t<decltype(*value)>;
            if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) {
              const bool not_given = section == "grid" && *value == 0;
              EXPECT_TRUE(not_given || (*value >= row.lowest && *value <= row.highest))
                  << section << "." << row.name;
            }
          },
          given);
    };
  };
  const auto check = [&](const std::string& section, const auto& parameters) {
    visit_parameters(parameters, check_row(section));
  };
  for (const Section* section : static_cast<const Sections&>(s.sections).all())
    section->visit(check_row(section->name()));
  check("grid", s.grid);
  check("species", SpeciesTraits{});
  check("wind", s.wind);
  check("wind", s.wind_regime);
  check("segment", WindSegment{});
  check("feature", WindFeatureParameters{});
  check("point of a feature's path", WindPathPoint{});
}

/// If this fails: desert_run --describe > config/parameters.md
TEST(ParametersPage, ConfigParametersMdIsNotStale) {
  if (!std::filesystem::exists(DESERT_SOURCE_DIR)) return;  // built elsewhere and carried here
  const std::string page = test::file_bytes(std::string(DESERT_SOURCE_DIR) + "/config/parameters.md");
  EXPECT_TRUE(page == describe_parameters())
      << "config/parameters.md is stale: desert_run --describe > config/parameters.md";
}

TEST(ParametersPage, NamesEverySectionKeyStepAndLayer) {
  const std::string page = describe_parameters();
  const auto expect_named = [&](const std::string& word) {
    EXPECT_NE(page.find("`" + word + "`"), std::string::npos) << word;
  };
  const Sections sections;
  EXPECT_GT(sections.all().size(), 20u);
  for (const Section* section : sections.all()) {
    expect_named(section->name());
    section->visit(
        ConstParameterVisit([&](const ParameterRow& row, ConstParameterValue) { expect_named(row.name); }));
  }
  for (const char* step : terrain_step_names)
    EXPECT_NE(page.find("### `" + std::string(step) + "`"), std::string::npos);
  for (const LayerInfo& row : layer_table)
    EXPECT_NE(page.find("`" + std::string(row.name) + "`"), std::string::npos);
}

}  // namespace
}  // namespace desert_sim
