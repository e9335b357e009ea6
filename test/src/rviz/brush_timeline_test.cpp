// The tool desert_sim/Brush with When set: strokes become entries of the timeline.

#include <desert_sim/ApplySettings.h>
#include <desert_sim/EditPlants.h>
#include <desert_sim/GetScenario.h>
#include <yaml-cpp/yaml.h>

#include "test/src/rviz/panel_window.hpp"
#include "test/src/rviz/tool_fixture.hpp"

namespace rviz_test {
namespace {

YAML::Node timeline_of_node() {
  const auto answer = call<desert_sim::GetScenario>("get_scenario");
  return YAML::Load(answer.yaml)["run"]["timeline"];
}

class LaterBrush : public RvizTools {
 protected:
  void SetUp() override {
    RvizTools::SetUp();
    if (!window_) return;
    desert_sim::ApplySettings::Request calm;  // the wind would carry away what is painted
    calm.settings = {"saltation.enabled=false"};
    ASSERT_TRUE(call<desert_sim::ApplySettings>("apply_settings", calm).success);
    brush_ = use_brush();
    time_step_ =
        YAML::Load(call<desert_sim::GetScenario>("get_scenario").yaml)["run"]["time_step"].as<double>();
  }
  void set_when(const char* name, double value) {
    rviz::Property* const found = property(brush_->getPropertyContainer(), {"When", name});
    ASSERT_TRUE(found) << name;
    found->setValue(value);
  }

  rviz::Tool* brush_ = nullptr;
  double time_step_ = 0;  ///< [s]
};

TEST_F(LaterBrush, AClickPaintsAtItsTimeAndThePanelListsIt) {
  PanelWindow panel("/desert_sim");
  panel.show_tab(timeline);
  ASSERT_TRUE(panel.run_until([&] { return panel.enabled("controls"); }));
  node_test::step(1);
  set_tool(brush_, "When", "From Now");
  set_when("Time", 2 * time_step_);
  const std::string start = hash();
  const std::vector<float> before = layer("sand_depth");
  mouse(QEvent::MouseMove, {65, 25}, Qt::NoButton);
  window_->run_frames(2);
  save("later");
  click({65, 25});
  wait_for(brush_);
  EXPECT_EQ(hash(), start) << "nothing is painted now";
  EXPECT_NE(text(brush_, "report").find("timeline: "), std::string::npos) << text(brush_, "report");
  ASSERT_EQ(timeline_of_node().size(), 1u);
  ASSERT_TRUE(panel.run_until([&] {
    return panel.cell_text("timeline_table", 0, 1).find("edit_terrain: layer sand, x ") == 0;
  })) << panel.cell_text("timeline_table", 0, 1);

  // A second one is not the next that happens, which alone ~status tells.
  set_when("Time", 3000 * time_step_);
  click({100, 50});
  wait_for(brush_);
  EXPECT_TRUE(panel.run_until([&] { return !panel.cell_text("timeline_table", 1, 1).empty(); }));

  node_test::step(2);
  EXPECT_NEAR(static_cast<double>(at(layer("sand_depth"), {65, 25})),
              static_cast<double>(at(before, {65, 25})), 0.05)
      << "it is not yet time";
  node_test::step(1);
  const std::vector<float> after = layer("sand_depth");
  EXPECT_NEAR(static_cast<double>(at(after, {65, 25}) - at(before, {65, 25})), 0.5, 0.1);
  EXPECT_NEAR(static_cast<double>(at(after, {100, 50})), static_cast<double>(at(before, {100, 50})), 0.05);
}

TEST_F(LaterBrush, AStraightStrokeIsOneEntryOfFullStrength) {
  set_tool(brush_, "When", "At Time");
  set_when("Time", time_step_);
  set_when("Every", 1.5 * time_step_);
  set_when("Until", 2.5 * time_step_);
  const std::vector<float> before = layer("sand_depth");
  drag({40, 10}, {90, 40}, 25);
  wait_for(brush_);
  const YAML::Node entries = timeline_of_node();
  ASSERT_EQ(entries.size(), 1u) << text(brush_, "report");
  EXPECT_EQ(entries[0]["shape"].as<std::string>(), "capsule");
  EXPECT_EQ(entries[0]["value"].as<double>(), 0.5);
  node_test::step(2);
  EXPECT_NEAR(static_cast<double>(at(layer("sand_depth"), {65, 25}) - at(before, {65, 25})), 0.5, 0.05);
  EXPECT_NEAR(static_cast<double>(at(layer("sand_depth"), {45, 13}) - at(before, {45, 13})), 0.5, 0.1);
  node_test::step(2);
  EXPECT_NEAR(static_cast<double>(at(layer("sand_depth"), {65, 25}) - at(before, {65, 25})), 1, 0.1);
}

/// Takes all plants away; how many there were.
long cleared_plants() {
  desert_sim::EditPlants::Request request;
  request.operation = request.CLEAR;
  request.shape = "circle";
  request.center.x = 32;
  request.center.y = 24;
  request.radius = 20;
  const auto answer = call<desert_sim::EditPlants>("edit_plants", request);
  EXPECT_TRUE(answer.success) << answer.message;
  return -answer.plants;
}

TEST_F(LaterBrush, PlantsArePutAtTheirTime) {
  load("garden.yaml");
  window_->look_from_above(32, 24, 10);
  EXPECT_TRUE(window_->run_until([&] {
    mouse(QEvent::MouseMove, {32, 24}, Qt::NoButton, Qt::NoModifier, 4);
    return brush_->property("over_terrain").toBool();
  }));
  set_tool(brush_, "When", "From Now");
  set_when("Time", 1);
  set_tool(brush_, "Material", "Plants");
  set_tool(brush_, "Species", "bush");
  set_tool(brush_, "Plant Density", 0.3);
  set_tool(brush_, "Plant Size", 0.1);
  drag({15, 20}, {45, 28}, 20, Qt::NoModifier, 4);
  wait_for(brush_);
  ASSERT_EQ(timeline_of_node().size(), 1u) << text(brush_, "report");
  EXPECT_EQ(cleared_plants(), 0) << "not yet";
  node_test::step(5);
  const long plants = cleared_plants();
  EXPECT_GT(plants, 20);
  EXPECT_LT(plants, 1.5 * 0.3 * 2 * 5 * 31) << "about the density on its width";
}

TEST_F(LaterBrush, WhatTheNodeRefusesIsSaidAtTheBrush) {
  set_tool(brush_, "When", "At Time");
  set_when("Time", 0);
  node_test::step(3);
  click({65, 25});
  wait_for(brush_);
  EXPECT_NE(text(brush_, "report").find("s is past"), std::string::npos) << text(brush_, "report");
  set_when("Time", 1e5);
  set_tool(brush_, "Material", "Plants");
  set_tool(brush_, "Species", "nobody");
  click({65, 25});
  wait_for(brush_);
  EXPECT_NE(text(brush_, "report").find("edit_plants: "), std::string::npos) << text(brush_, "report");
  set_tool(brush_, "Material", "Sand");
  set_tool(brush_, "Mask File", "stamp.asc");
  click({65, 25});
  wait_for(brush_);
  EXPECT_NE(text(brush_, "report").find("Mask File"), std::string::npos) << text(brush_, "report");
  EXPECT_EQ(timeline_of_node().size(), 0u);
}

}  // namespace
}  // namespace rviz_test
