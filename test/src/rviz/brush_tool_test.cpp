// The tool desert_sim/Brush in rviz.

#include <geometry_msgs/TransformStamped.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <cmath>

#include "test/src/rviz/tool_fixture.hpp"

namespace rviz_test {
namespace {

TEST_F(RvizTools, AStrokeChangesTheCellsUnderItAndUndoTakesItBack) {
  rviz::Tool* const brush = use_brush();
  const std::string start = hash();
  const std::vector<float> before = layer("sand_depth");
  const At from{40, 10}, to{90, 40};
  drag(from, to, 25);
  wait_for(brush);
  const std::string painted = hash();
  const std::vector<float> after = layer("sand_depth");
  expect_changed(before, after, from, to, 5);
  EXPECT_EQ(layer("bedrock"), std::vector<float>(columns * rows, 1));
  // A pass gives the strength in the middle.
  EXPECT_NEAR(static_cast<double>(at(after, {65, 25}) - at(before, {65, 25})), 0.5, 0.15);
  EXPECT_NE(text(brush, "report").find("sand +"), std::string::npos) << text(brush, "report");
  save("stroke");
  key(Qt::Key_Z);
  wait_for(brush);
  EXPECT_EQ(hash(), start) << text(brush, "report");
  key(Qt::Key_Y, Qt::ControlModifier);
  wait_for(brush);
  EXPECT_EQ(hash(), painted);
  key(Qt::Key_Z, Qt::ControlModifier);
  key(Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
  wait_for(brush);
  EXPECT_EQ(hash(), painted);
}

TEST_F(RvizTools, EveryStrokeIsUndoneByItself) {
  rviz::Tool* const brush = use_brush();
  std::vector<std::string> hashes = {hash()};
  for (const double y : {0.0, 15.0, 30.0}) {
    drag({30, y}, {100, y + 10}, 20, y == 15 ? Qt::ShiftModifier : Qt::NoModifier);
    wait_for(brush);
    hashes.push_back(hash());
    EXPECT_NE(hashes.back(), hashes[hashes.size() - 2]);
  }
  EXPECT_LT(at(layer("sand_depth"), {65, 20}), 0.5f) << "shift removes";
  for (int n = 2; n >= 0; --n) {
    key(Qt::Key_Z);
    wait_for(brush);
    EXPECT_EQ(hash(), hashes[static_cast<std::size_t>(n)]);
  }
  for (int n = 0; n < 4; ++n) {
    key(Qt::Key_Y, Qt::ControlModifier);
    wait_for(brush);
  }
  EXPECT_EQ(hash(), hashes.back());
  EXPECT_NE(text(brush, "report").find("no stroke"), std::string::npos) << text(brush, "report");
}

TEST_F(RvizTools, AFastStrokeIsComplete) {
  rviz::Tool* const brush = use_brush();
  const std::vector<float> before = layer("sand_depth");
  drag({30, 10}, {110, 60}, 200);
  wait_for(brush);
  expect_changed(before, layer("sand_depth"), {30, 10}, {110, 60}, 5);
}

TEST_F(RvizTools, AStrokeIsSeenWhileItIsPainted) {
  rviz::Tool* const brush = use_brush();
  mouse(QEvent::MouseMove, {20, 0}, Qt::NoButton);
  mouse(QEvent::MouseButtonPress, {20, 0}, Qt::LeftButton);
  for (double x = 40; x <= 120; x += 20) {
    const qulonglong before = calls(brush);
    const std::string state = hash();
    mouse(QEvent::MouseMove, {x, 0}, Qt::LeftButton);
    EXPECT_TRUE(window_->run_until([&] { return calls(brush) > before; })) << x;
    EXPECT_TRUE(window_->run_until([&] { return hash() != state; })) << x;
  }
  mouse(QEvent::MouseButtonRelease, {120, 0}, Qt::NoButton);
  wait_for(brush);
}

TEST_F(RvizTools, AMaskIsStampedByAClick) {
  rviz::Tool* const brush = use_brush();
  const std::string start = hash();
  set_tool(brush, "Mask File", "stamp.asc");
  set_tool(brush, "Radius", 16.0);
  set_tool(brush, "Strength", 2.0);
  mouse(QEvent::MouseMove, {65, 25}, Qt::NoButton);
  window_->run_frames(2);
  save("mask");
  click({65, 25});
  wait_for(brush);
  const std::vector<float> stamped = layer("sand_depth");
  EXPECT_NEAR(static_cast<double>(at(stamped, {55, 35})), 2.5, 0.3) << text(brush, "report");
  EXPECT_NEAR(static_cast<double>(at(stamped, {75, 15})), 0.5, 1e-3);
  EXPECT_EQ(at(stamped, {65, 45}), 0.5f);
  key(Qt::Key_Z);
  wait_for(brush);
  EXPECT_EQ(hash(), start);
  set_tool(brush, "Material", "Plants");
  click({65, 25});
  EXPECT_NE(text(brush, "report").find("Mask File"), std::string::npos) << text(brush, "report");
}

/// What is no material: shares of 1, which undo takes back.
TEST_F(RvizTools, VegetationAndErosionResistanceArePaintedAndUndone) {
  rviz::Tool* const brush = use_brush();
  const std::string start = hash();
  set_tool(brush, "Strength", 0.6);
  for (const auto& [material, name] :
       {std::pair("Vegetation", "vegetation"), {"Erosion Resistance", "erosion_resistance"}}) {
    set_tool(brush, "Material", material);
    drag({40, 10}, {90, 40}, 25);
    wait_for(brush);
    const std::vector<float> painted = layer(name);
    EXPECT_NEAR(static_cast<double>(at(painted, {65, 25})), 0.6, 0.15) << text(brush, "report");
    EXPECT_EQ(at(painted, {20, 60}), 0);
    EXPECT_EQ(text(brush, "report"), name);
  }
  set_tool(brush, "Operation", "Flatten");
  drag({40, 10}, {60, 10}, 5);
  EXPECT_NE(text(brush, "report").find("another Operation"), std::string::npos) << text(brush, "report");
  set_tool(brush, "Material", "Vegetation");
  drag({65, 25}, {100, 60}, 20);
  wait_for(brush);
  EXPECT_NEAR(static_cast<double>(at(layer("vegetation"), {90, 50})), 0.6, 0.15)
      << "as dense as where it began";
  save("vegetation");
  for (int n = 0; n < 3; ++n) key(Qt::Key_Z);
  wait_for(brush);
  EXPECT_EQ(hash(), start);
}

TEST_F(RvizTools, ObstaclesRockAndRefusals) {
  rviz::Tool* const brush = use_brush();
  const std::string start = hash();
  set_tool(brush, "Material", "Obstacle");
  drag({40, 10}, {60, 10}, 5);
  wait_for(brush);
  EXPECT_EQ(at(layer("obstacle"), {51, 11}), 1.0f) << text(brush, "report");
  drag({40, 10}, {60, 10}, 5, Qt::ShiftModifier);
  wait_for(brush);
  EXPECT_EQ(layer("obstacle"), std::vector<float>(columns * rows, 0));
  set_tool(brush, "Material", "Rock");
  drag({80, 40}, {80, 40}, 1);
  wait_for(brush);
  EXPECT_NEAR(static_cast<double>(at(layer("bedrock"), {79, 39})), 1.5, 0.01) << "a click gives the strength";
  set_tool(brush, "Operation", "Flatten");
  drag({79, 39}, {95, 39}, 8);
  wait_for(brush);
  EXPECT_NEAR(static_cast<double>(at(layer("bedrock"), {91, 39})), 1.5, 0.02) << "as high as where it began";
  for (int n = 0; n < 4; ++n) key(Qt::Key_Z);
  wait_for(brush);
  EXPECT_EQ(hash(), start);

  set_tool(brush, "Material", "Plants");
  drag({40, 10}, {60, 10}, 5);
  EXPECT_NE(text(brush, "report").find("Operation"), std::string::npos) << text(brush, "report");
  set_tool(brush, "Operation", "Add");
  drag({40, 10}, {60, 10}, 5);
  EXPECT_NE(text(brush, "report").find("Species"), std::string::npos) << text(brush, "report");
  set_tool(brush, "Material", "Water");
  drag({40, 10}, {60, 10}, 5);
  wait_for(brush);
  EXPECT_NE(text(brush, "report").find("no layer water"), std::string::npos) << "what the node says is shown";
  save("refused");
  EXPECT_EQ(hash(), start);
}

TEST_F(RvizTools, TheWheelChangesRadiusAndStrength) {
  rviz::Tool* const brush = use_brush();
  wheel({70, 30}, 2);
  EXPECT_NEAR(get_tool(brush, "Radius"), 5 * 1.21, 1e-4);
  EXPECT_NEAR(get_tool(brush, "Strength"), 0.5, 1e-6);
  wheel({70, 30}, -1, Qt::ControlModifier);
  EXPECT_NEAR(get_tool(brush, "Strength"), 0.5 / 1.1, 1e-4);
  EXPECT_NEAR(get_tool(brush, "Radius"), 5 * 1.21, 1e-4);
}

TEST_F(RvizTools, PaintsWhatIsSeenThoughExaggeratedAndTurned) {
  tf2_ros::StaticTransformBroadcaster broadcaster;
  geometry_msgs::TransformStamped turned;
  turned.header.stamp = ros::Time::now();
  turned.header.frame_id = "turned";
  turned.child_frame_id = "terrain";
  turned.transform.translation.z = 7;
  turned.transform.rotation.z = turned.transform.rotation.w = std::sqrt(0.5);  // (x, y) is at (-y, x)
  broadcaster.sendTransform(turned);
  window_->set_fixed_frame("turned");
  set(display_, {"Vertical Exaggeration"}, 10);
  const double z = 7 + 10 * surface;
  window_->look_at(80);
  rviz::Property* const focus = window_->manager().getViewManager()->getCurrent()->subProp("Focal Point");
  focus->subProp("X")->setValue(-30);
  focus->subProp("Y")->setValue(55);
  focus->subProp("Z")->setValue(z);
  rviz::Tool* const brush = use("desert_sim/Brush");
  set_tool(brush, "Strength", 0.01);  // ground that rises under the mouse would turn the stroke aside
  EXPECT_TRUE(window_->run_until([&] {
    mouse(QEvent::MouseMove, {-30, 60}, Qt::NoButton, Qt::NoModifier, z);
    return brush->property("over_terrain").toBool();
  }));
  const std::vector<float> before = layer("sand_depth");
  drag({-20, 50}, {-40, 60}, 10, Qt::NoModifier, z);
  wait_for(brush);
  expect_changed(before, layer("sand_depth"), {50, 20}, {60, 40}, 5, 0.7);
  save("turned");
}

TEST_F(RvizTools, TheNodesAbsenceIsAMessage) {
  rviz::Tool* const brush = use_brush();
  set_tool(brush, "Node", "/nobody");
  mouse(QEvent::MouseMove, {70, 30}, Qt::NoButton);
  EXPECT_FALSE(brush->property("over_terrain").toBool());
  drag({40, 10}, {60, 10}, 5);
  EXPECT_NE(text(brush, "report").find("/nobody"), std::string::npos) << text(brush, "report");
  key(Qt::Key_Z);
  wait_for(brush);
  EXPECT_NE(text(brush, "report").find("/nobody/undo"), std::string::npos) << text(brush, "report");
}

TEST_F(RvizTools, ShowsTheOutline) {
  rviz::Tool* const brush = use_brush();
  window_->look_at(60);
  set_tool(brush, "Radius", 12);
  mouse(QEvent::MouseMove, {-200, 25}, Qt::NoButton);
  window_->run_frames(2);
  EXPECT_FALSE(brush->property("over_terrain").toBool());
  const std::size_t without = window_->colours();
  mouse(QEvent::MouseMove, {50, 25}, Qt::NoButton);
  window_->run_frames(2);
  EXPECT_GE(window_->colours(), without + 2) << "two rings";
  save("hover");
}

}  // namespace
}  // namespace rviz_test
