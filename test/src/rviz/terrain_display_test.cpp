// The display desert_sim/Terrain in rviz, on a screen of Xvfb: what people complain of in comparable plugins,
// by number (test/src/rviz/README.md), and what can go wrong around it.

#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <desert_sim/Plants.h>
#include <desert_sim/WindField.h>
#include <rviz/properties/status_property.h>
#include <tf2_ros/transform_broadcaster.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "test/src/rviz/terrain_fixture.hpp"
#include "test/support/ros/client.hpp"

namespace rviz_test {
namespace {

using rviz::StatusProperty;

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

/// The boxes of all meshes that are drawn below a node, in the fixed frame.
void collect_boxes(const Ogre::Node* node, std::vector<Ogre::AxisAlignedBox>& boxes) {
  if (const auto* scene_node = dynamic_cast<const Ogre::SceneNode*>(node))
    for (unsigned short n = 0; n < scene_node->numAttachedObjects(); ++n) {
      Ogre::MovableObject* const object = const_cast<Ogre::SceneNode*>(scene_node)->getAttachedObject(n);
      if (object->getMovableType() == "SimpleRenderable" && object->isVisible())
        boxes.push_back(object->getWorldBoundingBox(true));
    }
  for (unsigned short n = 0; n < node->numChildren(); ++n) collect_boxes(node->getChild(n), boxes);
}

/// The box of everything that is drawn of the terrain, in the fixed frame.
Ogre::AxisAlignedBox drawn(const Ogre::Node* node) {
  std::vector<Ogre::AxisAlignedBox> boxes;
  collect_boxes(node, boxes);
  Ogre::AxisAlignedBox all;
  for (const Ogre::AxisAlignedBox& box : boxes) all.merge(box);
  return all;
}

TEST_F(TerrainDisplay, DrawsThePicture) {
  MadeUpNode node("/drawn");
  rviz::Display* const display = show(node, "/drawn", 256);
  set(display, {"Contour Interval"}, 2);
  window_->run_frames(1);
  EXPECT_TRUE(settles(display));
  window_->run_frames(2);  // statuses are shown in the frame after
  EXPECT_GT(window_->colours(), 100u);
  EXPECT_EQ(status(display, "Terrain").level, StatusProperty::Ok);
  EXPECT_NE(status(display, "Terrain").text.find("256 x 256 cells"), std::string::npos);
  EXPECT_NE(status(display, "Blocks").text.find("0 of 16 wait"), std::string::npos)
      << status(display, "Blocks").text;
}

// (1) Big maps stall rviz. terrain_display_timing_test.cpp measures how long frames take.
TEST_F(TerrainDisplay, Complaint1ALargeKeyframeIsBuiltInManyFramesAndItsTrianglesAreBounded) {
  MadeUpNode node("/large");
  rviz::Display* const display = show(node, "/large", 256);
  set(display, {"Time per Frame"}, 1);
  double most_built = 0, built = number(display, "built_blocks");
  window_->for_each_frame([&] {
    most_built = std::max(most_built, number(display, "built_blocks") - built);
    built = number(display, "built_blocks");
  });
  node.keyframe(2048, 2048, dunes);
  EXPECT_TRUE(settles(display, [&] { return number(display, "blocks") == 256; }));
  window_->run_frames(1);
  EXPECT_GE(most_built, 1);
  EXPECT_LT(most_built, 256) << "they do not come all at once";
  EXPECT_LE(number(display, "triangles"), 200000) << "of which 40000 are in the picture";
}

// (2) One frame a second unless built for release.
TEST_F(TerrainDisplay, Complaint2WarnsWithoutOptimisation) {
  MadeUpNode node("/build");
  rviz::Display* const display = show(node, "/build", 64);
#ifdef __OPTIMIZE__
  EXPECT_EQ(status(display, "Build").level, -1) << "an optimised build does not warn";
#else
  EXPECT_EQ(status(display, "Build").level, StatusProperty::Warn);
#endif
}

// (3) A crash on a missing layer.
TEST_F(TerrainDisplay, Complaint3AMissingLayerIsAStatus) {
  MadeUpNode node("/missing");
  rviz::Display* const display = show(node, "/missing", 128);
  set(display, {"Overlay"}, "no_such_layer");
  EXPECT_TRUE(window_->run_until([&] { return status(display, "Overlay").level == StatusProperty::Error; }));
  EXPECT_NE(status(display, "Overlay").text.find("traversability"), std::string::npos)
      << "it says what there is";
  set(display, {"Overlay"}, "wind_shadow");  // known, but this node does not send it
  EXPECT_TRUE(window_->run_until([&] { return status(display, "Overlay").level == StatusProperty::Warn; }));
  set(display, {"Overlay"}, "slope");
  EXPECT_TRUE(window_->run_until([&] { return status(display, "Overlay").level == StatusProperty::Ok; }));
  EXPECT_TRUE(settles(display));
  EXPECT_GT(window_->colours(), 100u);
}

// (4) NaN crashes OGRE.
TEST_F(TerrainDisplay, Complaint4UnknownCellsAreHoles) {
  MadeUpNode node("/unknown");
  rviz::Display* const display =
      show(node, "/unknown", 128, [](int x, int y) { return x < 64 ? dunes(x, y) : unknown; });
  EXPECT_LT(drawn(window_->manager().getSceneManager()->getRootSceneNode()).getMaximum().x, 66);
  node.update(0, 0, 128, 128, [](int, int) { return unknown; });
  EXPECT_TRUE(window_->run_until([&] { return number(display, "triangles") == 0; }));
  window_->run_frames(2);  // without a crash
  node.update(0, 0, 128, 128, dunes);
  EXPECT_TRUE(settles(display));
  node.keyframe(1, 50, dunes);
  EXPECT_TRUE(window_->run_until([&] { return status(display, "Terrain").level == StatusProperty::Error; }));
  EXPECT_NE(status(display, "Terrain").text.find("at least 2 x 2"), std::string::npos);
}

// (5) The whole map is sent again for a small change.
TEST_F(TerrainDisplay, Complaint5ASmallUpdateBuildsOnlyItsBlocks) {
  MadeUpNode node("/small");
  rviz::Display* const display = show(node, "/small", 512);
  set(display, {"Shadows"}, false);  // which fall on blocks further east
  EXPECT_TRUE(settles(display));
  double messages = 0;
  window_->for_each_frame([&] { messages += number(display, "frame_messages"); });
  const auto built_after = [&](double of_messages) {
    EXPECT_TRUE(settles(display, [&] { return messages == of_messages; }));
    return number(display, "built_blocks");
  };
  window_->run_frames(1);
  const double before = number(display, "built_blocks");
  node.update(90, 90, 16, 16, [](int x, int y) { return dunes(x, y) + 0.5f; });
  EXPECT_EQ(built_after(1), before + 1);
  // The same elevations in a new keyframe, and then a small change of it, which the client takes after it.
  node.keyframe(512, 512, [](int x, int y) {
    return x >= 90 && x < 106 && y >= 90 && y < 106 ? dunes(x, y) + 0.5f : dunes(x, y);
  });
  node.update(280, 280, 16, 16, [](int x, int y) { return dunes(x, y) + 0.5f; });
  EXPECT_EQ(built_after(2), before + 2);
}

TEST_F(TerrainDisplay, AHillDarkensTheBlockThatItsShadowFallsOn) {
  MadeUpNode node("/shady");
  rviz::Display* const display = show(node, "/shady", 256, [](int x, int) { return x < 5 ? 30.0f : 0.0f; });
  window_->run_frames(1);
  const double before = number(display, "built_blocks");
  node.update(50, 90, 5, 5, [](int, int) { return 20.0f; });  // block (0, 1); its shadow ends in block (1, 1)
  EXPECT_TRUE(settles(display, [&] { return number(display, "built_blocks") >= before + 2; }));
}

TEST_F(TerrainDisplay, AllBlocksOfAnUpdateAppearInTheSameFrame) {
  constexpr float higher = 100;
  MadeUpNode node("/together");
  rviz::Display* const display = show(node, "/together", 512);
  set(display, {"Shadows"}, false);
  EXPECT_TRUE(settles(display));
  set(display, {"Time per Frame"}, 1);
  int frames_of_building = 0, mixed_frames = 0;
  double built = number(display, "built_blocks");
  window_->for_each_frame([&] {
    std::vector<Ogre::AxisAlignedBox> boxes;
    collect_boxes(window_->manager().getSceneManager()->getRootSceneNode(), boxes);
    const auto risen = std::count_if(boxes.begin(), boxes.end(), [](const Ogre::AxisAlignedBox& box) {
      return box.getMaximum().z > higher / 2;
    });
    mixed_frames += risen != 0 && risen != static_cast<std::ptrdiff_t>(boxes.size());
    frames_of_building += risen == 0 && number(display, "built_blocks") > built;
    built = number(display, "built_blocks");
  });
  const double before = built;
  node.update(0, 0, 512, 512, [](int x, int y) { return dunes(x, y) + higher; });
  EXPECT_TRUE(settles(display, [&] { return built >= before + 64; }));
  EXPECT_EQ(mixed_frames, 0);
  EXPECT_GT(frames_of_building, 1) << "else nothing was shown here";
}

TEST_F(TerrainDisplay, TheSkySurroundsTheCameraOnRequest) {
  MadeUpNode node("/sky");
  rviz::Display* const display = show(node, "/sky", 64);
  const auto extent = [&] {
    window_->run_frames(2);
    return drawn(window_->manager().getSceneManager()->getRootSceneNode()).getMaximum().z;
  };
  EXPECT_LT(extent(), 100);
  set(display, {"Sky"}, true);
  EXPECT_GT(extent(), 1e4);
  display->setEnabled(false);
  EXPECT_FALSE(extent() > 1e4);
}

// (6) Memory that grows.
TEST_F(TerrainDisplay, Complaint6MemoryIsFlatOverUpdatesAndResizes) {
  MadeUpNode node("/memory");
  rviz::Display* const display = show(node, "/memory", 256);
  set(display, {"Contour Interval"}, 3);
  set(display, {"Overlay"}, "change");
  const auto updates = [&](int count) {
    for (int n = 0; n < count; ++n) {
      node.update(n * 7 % 192, n * 11 % 192, 64, 64, [n](int x, int y) { return dunes(x + n, y); });
      if (n % 5 == 0) window_->run_frames(1);
    }
  };
  const auto resizes = [&](int count) {
    for (int n = 0; n < count; ++n) {
      node.keyframe(100 + 37 * (n % 10), 400 - 31 * (n % 10), dunes);
      EXPECT_TRUE(settles(display));
    }
    node.keyframe(256, 256, dunes);
    EXPECT_TRUE(settles(display));
  };
  updates(200);
  resizes(10);  // what libraries keep once is there now
  const double growth = steady_growth_megabytes([&] {
    updates(250);
    resizes(5);
  });
  EXPECT_LT(growth, 3);
}

// (7) The wrong level of detail in the top-down view.
TEST_F(TerrainDisplay, Complaint7TheTopDownViewHasDetailByItsScale) {
  MadeUpNode node("/top_down");
  rviz::Display* const display = show(node, "/top_down", 1024);
  set(display, {"Most Triangles"}, 10000000);  // so that the scale alone decides
  const auto triangles_at = [&](double pixels_per_metre) {
    window_->look_from_above(512, 512, pixels_per_metre);
    EXPECT_TRUE(settles(display));
    return number(display, "triangles");
  };
  // Scales between those at which a level begins.
  const double far = triangles_at(0.1), near = triangles_at(0.8), nearest = triangles_at(8);
  EXPECT_LT(far, 0.1 * near);
  EXPECT_GT(nearest, 2 * 1023 * 1023) << "all blocks in full detail";
  EXPECT_EQ(triangles_at(0.1), far);
}

// (8) No throttle when messages come faster than frames.
TEST_F(TerrainDisplay, Complaint8MessagesFasterThanFramesAreTakenTogether) {
  MadeUpNode node("/fast");
  rviz::Display* const display = show(node, "/fast", 256);
  window_->run_frames(1);
  double messages = 0, most = 0, sent = 0;
  window_->for_each_frame([&] {
    messages += number(display, "frame_messages");
    most = std::max(most, number(display, "frame_messages"));
  });
  const double built = number(display, "built_blocks");
  const std::uint64_t frames = window_->frames();
  // All of them are in the client's queue before a frame is drawn; the client can be slow to take them from
  // there.
  EXPECT_TRUE(node_test::wait_until([&] {
    for (int n = 0; n < 150; ++n, ++sent)  // fewer than the client's queue holds
      node.update(0, 0, 64, 64, [&](int x, int y) { return dunes(x, y) + 0.01f * static_cast<float>(sent); });
    EXPECT_TRUE(window_->run_until([&] { return messages >= sent; }));
    return most > 1;
  }));
  window_->run_frames(2);
  EXPECT_EQ(messages, sent);
  EXPECT_LE(number(display, "built_blocks") - built, 4.0 * static_cast<double>(window_->frames() - frames));
  EXPECT_EQ(status(display, "Topic").level, StatusProperty::Ok) << status(display, "Topic").text;
}

TEST_F(TerrainDisplay, SaysWhatToDoWithoutANodeAndWhenItEnds) {
  rviz::Display* const display = window_->add_terrain("/nobody/elevation");
  EXPECT_TRUE(window_->run_until([&] { return status(display, "Topic").level == StatusProperty::Error; }));
  EXPECT_NE(status(display, "Topic").text.find("roslaunch desert_sim"), std::string::npos);
  MadeUpNode node("/ending");
  rviz::Display* const shown = show(node, "/ending", 64);
  EXPECT_TRUE(window_->run_until([&] { return status(shown, "Topic").level == StatusProperty::Ok; }));
  node.end();
  EXPECT_TRUE(window_->run_until([&] { return status(shown, "Topic").level == StatusProperty::Warn; }));
  EXPECT_NE(status(shown, "Topic").text.find("start the node again"), std::string::npos);
  EXPECT_GT(number(shown, "triangles"), 0) << "the last terrain stays";
  MadeUpNode again("/ending");
  again.keyframe(100, 100, dunes);
  EXPECT_TRUE(window_->run_until([&] {
    return status(shown, "Terrain").text.find("100 x 100") != std::string::npos;
  })) << status(shown, "Terrain").text;
}

TEST_F(TerrainDisplay, MessagesThatNoDesertSendsEndNothing) {
  constexpr float huge = 3e38f, infinite = std::numeric_limits<float>::infinity();
  MadeUpNode node("/hostile");
  rviz::Display* const display = show(node, "/hostile", 64);
  set(display, {"Plants"}, true);
  set(display, {"Wind"}, true);
  ros::NodeHandle handle;
  ros::Publisher plants = handle.advertise<desert_sim::Plants>("/hostile/plants", 10);
  ros::Publisher winds = handle.advertise<desert_sim::WindField>("/hostile/wind", 10);
  ASSERT_TRUE(
      window_->run_until([&] { return plants.getNumSubscribers() > 0 && winds.getNumSubscribers() > 0; }));
  for (const float value : {unknown, infinite, huge, -huge}) {
    node.keyframe(64, 64, [=](int x, int y) { return x == 30 && y == 20 ? value : dunes(x, y); });
    node.keyframe(64, 64, dunes, static_cast<double>(value));
    node.update(3, 3, 20, 20, [=](int, int) { return value; });
    desert_sim::Plants some;
    some.species.resize(1);
    some.species[0].stem = 1;
    for (const float x : {5.0f, value, 8.0f, 9.0f, 10.0f}) {
      some.x.push_back(x);
      some.y.push_back(x == 8 ? value : 5);
      some.z.push_back(x == 9 ? value : 0);
      some.radius.push_back(x == 10 ? value : 1);
      some.species_index.push_back(0);
      some.health.push_back(255);
    }
    plants.publish(some);
    some.origin.position.x = static_cast<double>(value);
    plants.publish(some);
    desert_sim::WindField wind;
    wind.width = wind.height = 4;
    wind.cell_size = 16;
    wind.u.assign(16, value);
    wind.v.assign(16, 2);
    wind.above.x = static_cast<double>(value);
    winds.publish(wind);
    wind.u.assign(16, 5);
    wind.cell_size = static_cast<double>(value);
    winds.publish(wind);
    window_->run_frames(10);
  }
  node.keyframe(90, 80, dunes);
  EXPECT_TRUE(window_->run_until([&] {
    return status(display, "Terrain").text.find("90 x 80") != std::string::npos;
  })) << status(display, "Terrain").text;
  EXPECT_TRUE(drawn(window_->manager().getSceneManager()->getRootSceneNode()).isFinite());
}

TEST_F(TerrainDisplay, TwoDisplaysShowTwoNodes) {
  MadeUpNode first("/first"), second("/second");
  rviz::Display* const one = show(first, "/first", 128);
  rviz::Display* const two = show(second, "/second", 64);
  for (rviz::Display* display : {one, two}) set(display, {"Overlay"}, "slope");  // both have a legend
  EXPECT_TRUE(settles(one));
  EXPECT_TRUE(settles(two));
  EXPECT_EQ(number(one, "blocks"), 4);
  EXPECT_EQ(number(two, "blocks"), 1);
  window_->remove(one);
  window_->run_frames(2);
  const double built = number(two, "built_blocks");
  second.update(0, 0, 10, 10, [](int, int) { return 9.0f; });
  EXPECT_TRUE(settles(two, [&] { return number(two, "built_blocks") > built; }));
  window_->remove(two);
  window_->run_frames(2);
}

TEST_F(TerrainDisplay, FollowsAMovingFixedFrame) {
  MadeUpNode node("/moving", "terrain");
  rviz::Display* const display = window_->add_terrain("/moving/elevation");
  set(display, {"Sky"}, false);
  set(display, {"Materials"}, false);
  node.keyframe(64, 64, dunes);
  EXPECT_TRUE(
      window_->run_until([&] { return status(display, "Transform").level == StatusProperty::Error; }));
  EXPECT_NE(status(display, "Transform").text.find("choose [terrain] as Fixed Frame"), std::string::npos);
  tf2_ros::TransformBroadcaster broadcaster;
  const auto west_edge = [&](double x) {
    geometry_msgs::TransformStamped t;
    t.header.frame_id = "map";
    t.child_frame_id = "terrain";
    t.transform.rotation.w = 1;
    t.transform.translation.x = x;
    Ogre::Real edge = 0;
    window_->run_until([&] {
      t.header.stamp = ros::Time::now();
      broadcaster.sendTransform(t);
      window_->run_frames(1);
      edge = drawn(window_->manager().getSceneManager()->getRootSceneNode()).getMinimum().x;
      return std::abs(static_cast<double>(edge) - (x + 0.5)) < 0.01;
    });
    return static_cast<double>(edge);
  };
  EXPECT_NEAR(west_edge(100), 100.5, 0.01);
  EXPECT_TRUE(settles(display));
  const double built = number(display, "built_blocks");
  EXPECT_NEAR(west_edge(-30), -29.5, 0.01);
  EXPECT_EQ(number(display, "built_blocks"), built) << "a move builds nothing anew";
}

TEST_F(TerrainDisplay, ExaggerationsAndDisablingWork) {
  MadeUpNode node("/exaggerated");
  rviz::Display* const display = show(node, "/exaggerated", 64);
  const auto height = [&] {
    return drawn(window_->manager().getSceneManager()->getRootSceneNode()).getSize().z;
  };
  const Ogre::Real before = height();
  set(display, {"Vertical Exaggeration"}, 3);
  window_->run_frames(2);
  EXPECT_TRUE(settles(display));
  EXPECT_NEAR(height(), 3 * before, 0.01F);
  display->setEnabled(false);
  window_->run_frames(1);
  EXPECT_EQ(number(display, "blocks"), 0);
  display->setEnabled(true);
  EXPECT_TRUE(settles(display));
}

}  // namespace
}  // namespace rviz_test

int main(int argc, char** argv) { return rviz_test::run_terrain_tests(argc, argv, "terrain_display_test"); }
