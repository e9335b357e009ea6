// One model moves the sand, and what it does stands in for what others would.
#include <gtest/gtest.h>

#include <map>

#include "kernels/backend/exec.hpp"
#include "src/core/error.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

class SandModels : public testing::Test {
 protected:
  std::unique_ptr<Simulation> simulation(const std::string& yaml) {
    return test::simulate(*exec_,
                          "grid: {width: 32, height: 24, cell_size: 0.5}\n"
                          "terrain: [{uniform: {layer: sand, value: 1}}]\n" +
                              yaml);
  }
  std::set<std::string> processes(const std::string& yaml) {
    std::set<std::string> names;
    const auto s = simulation(yaml);
    for (const Pipeline::Stage& stage : s->pipeline().stages()) names.insert(stage.process->name);
    return names;
  }
  std::unique_ptr<Exec> exec_ = make_exec("cpu", 1);
};

TEST_F(SandModels, EachTakesTheSandAlone) {
  for (const std::string model : sand_model_names) {
    SCOPED_TRACE(model);
    const std::set<std::string> active = processes("sand: {model: " + model + "}\n");
    for (const std::string other : sand_model_names) {
      const std::string process = other == "hops" ? "saltation" : other;
      EXPECT_EQ(active.count(process), other == model ? 1u : 0u) << process;
    }
  }
}

TEST_F(SandModels, WhatStandsInForOthersIsTheRowsOwnBusiness) {
  const std::map<std::string, std::set<std::string>> absent{
      {"hops", {"repose"}},
      {"desertscape_2019", {"reptation"}},
      {"continuum", {"wind", "wind_shadow"}},
      {"werner", {"wind", "wind_shadow", "repose", "reptation", "avalanching"}},
      {"wang", {"wind", "wind_shadow", "reptation"}}};
  const std::set<std::string> all{"wind", "wind_shadow", "repose", "reptation", "avalanching"};
  for (const auto& [model, gone] : absent) {
    SCOPED_TRACE(model);
    const std::set<std::string> active =
        processes("sand: {model: " + model + "}\nreptation: {method: smoothing}\n");
    for (const std::string& process : all)
      EXPECT_EQ(active.count(process), 1 - gone.count(process)) << process;
  }
  EXPECT_EQ(processes("sand: {model: continuum}\n").count("shear_stress"), 1u);
}

TEST_F(SandModels, SaltationThatIsOffMovesNothing) {
  for (const std::string model : {"hops", "desertscape_2019", "continuum"}) {
    const std::set<std::string> active =
        processes("sand: {model: " + model + "}\nsaltation: {enabled: false}\n");
    EXPECT_EQ(active.count("saltation") + active.count(model), 0u) << model;
    EXPECT_EQ(active.count("wind") + active.count("repose"), 2u) << model;
  }
}

TEST_F(SandModels, ARunningOneChangesToAnother) {
  const auto s = simulation("sand: {model: werner}\n");
  for (const char* model : {"continuum", "wang", "hops", "snow", "desertscape_2019", "werner"}) {
    s->apply(command::SetParameters{{std::string("sand.model=") + model}, 0});
    test::run(*s, 2);
    test::expect_sound(*s, model);
  }
}

TEST(ProcessTable, EachRoleHasOneActiveProcess) {
  const ProcessTable& table = process_table();
  for (const std::string model : sand_model_names)
    for (const char* enabled : {"true", "false"}) {
      SCOPED_TRACE(model + ", saltation.enabled: " + enabled);
      const Scenario s = parse_scenario_text("grid: {width: 16, height: 16}\nsand: {model: " + model +
                                                 "}\nsaltation: {flux: true, enabled: " + enabled + "}\n",
                                             "roles");
      std::map<Role, std::string> taken;
      for (const Process& p : table.processes) {
        if (!table.is_active(p, s)) continue;
        for (Role role : p.roles) {
          EXPECT_TRUE(taken.emplace(role, p.name).second) << p.name << " and " << taken[role];
        }
      }
      EXPECT_TRUE(taken.count(Role::wind));
    }
}

}  // namespace
}  // namespace desert_sim
