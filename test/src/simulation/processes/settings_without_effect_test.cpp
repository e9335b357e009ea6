// Settings that nothing reads are told, and none that something reads.
#include "src/simulation/processes/settings_without_effect.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "src/scenario/scenario_file.hpp"
#include "test/support/running.hpp"

namespace desert_sim {
namespace {

std::string told(const std::string& scenario, const Settings& settings = {}) {
  std::string all;
  for (const std::string& line : settings_without_effect(shipped(scenario, settings))) all += line + "\n";
  return all;
}

TEST(SettingsWithoutEffect, ShippedScenariosHaveNone) {
  int scenarios = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source_folder() + "/config/scenarios")) {
    if (entry.path().extension() != ".yaml") continue;
    ++scenarios;
    EXPECT_EQ(told(entry.path().stem().string()), "") << entry.path();
  }
  EXPECT_GT(scenarios, 20);
}

TEST(SettingsWithoutEffect, SectionsThatNoProcessReadsAreTold) {
  EXPECT_NE(told("werner_barchan", {"abrasion.rate=0.1"}).find("abrasion: has no effect"), std::string::npos);
  EXPECT_EQ(told("barchan", {"abrasion.rate=0.1"}), "");
  EXPECT_EQ(told("barchan", {"soil.drying=0.1"}), "") << "switched off";
}

TEST(SettingsWithoutEffect, SoAreWindsEdgesAndSeas) {
  EXPECT_NE(told("barchan", {"wind.regime=constant", "wind.segments=[{speed: 5, duration: 100}]"})
                .find("wind.segments: have no effect"),
            std::string::npos);
  const Settings influx{"saltation.influx=0.001"};
  EXPECT_NE(told("barchan", {"grid.boundary=periodic", influx[0]}).find("saltation.influx: has no effect"),
            std::string::npos);
  EXPECT_EQ(told("barchan", {"grid.boundary=open", influx[0]}), "");
  EXPECT_NE(told("barchan", {"water.sea=border"}).find("water.sea: has no effect"), std::string::npos);
  EXPECT_EQ(told("barchan", {"water.sea=border", "water.enabled=true"}), "");
}

TEST(SettingsWithoutEffect, SoAreRepetitionsWithinAStep) {
  const auto every = [](const std::string& time) {
    return told("barchan", {"run.timeline=[{time: 1, every: " + time + ", set: {wind.speed: 5}}]"});
  };
  EXPECT_NE(every("0.5").find("run.timeline.0.every: 0.5 s is shorter than a step of 1 s"),
            std::string::npos);
  EXPECT_EQ(every("1"), "");
}

}  // namespace
}  // namespace desert_sim
