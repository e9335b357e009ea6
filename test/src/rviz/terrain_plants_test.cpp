// The plants of the display desert_sim/Terrain: shapes where they are near, a picture on the ground where
// far.

#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>

#include <cstdlib>
#include <limits>

#include "test/src/rviz/made_up_plants.hpp"
#include "test/src/rviz/terrain_fixture.hpp"

namespace rviz_test {
namespace {

constexpr int side = 256;

float level(int, int) { return 0; }

class TerrainPlants : public TerrainDisplay {
 protected:
  /// A display of level ground whose plants come from publisher().
  rviz::Display* show_ground(MadeUpNode& node, const std::string& name) {
    rviz::Display* const display = show(node, name, side, level);
    set(display, {"Plants"}, true);
    publisher_ = handle_.advertise<desert_sim::Plants>(name + "/plants", 1);
    EXPECT_TRUE(window_->run_until([this] { return publisher_.getNumSubscribers() > 0; }));
    return display;
  }
  /// Waits until so many plants are known, and all of them is shown that is to be.
  static bool has(rviz::Display* display, double plants) {
    return window_->run_until([&] {
      if (number(display, "known_plants") != plants || number(display, "waiting_plants") != 0) return false;
      window_->run_frames(1);
      return number(display, "waiting_plants") == 0 && number(display, "known_plants") == plants;
    });
  }
  /// Looks at the middle of the ground from so far; until all that is near is built.
  static void look_from(rviz::Display* display, double distance) {
    window_->look_at(side);
    window_->manager().getViewManager()->getCurrent()->subProp("Distance")->setValue(distance);
    window_->run_frames(3);
    EXPECT_TRUE(window_->run_until([&] { return number(display, "waiting_plants") == 0; }));
    window_->run_frames(1);
  }
  static void keep_picture(const std::string& name) {
    if (const char* folder = std::getenv("DESERT_PICTURES"))
      window_->save(std::string(folder) + "/" + name + ".png");
  }
  /// Crowns of this radius, side by side on the western half of the ground.
  static desert_sim::PlantsPtr western_half(float radius) {
    auto plants = made_up_plants(0, side, 0);
    for (float y = 2; y < side - 2; y += radius)
      for (float x = 2; x < side / 2; x += radius) {
        plants->x.push_back(x);
        plants->y.push_back(y);
        plants->z.push_back(0);
        plants->radius.push_back(radius);
        plants->species_index.push_back(0);
        plants->health.push_back(255);
      }
    plants->total = plants->x.size();
    return plants;
  }
  static int green_over_red(std::uint32_t pixel) {
    return static_cast<int>(pixel >> 8 & 255) - static_cast<int>(pixel >> 16 & 255);
  }

  ros::NodeHandle handle_;
  ros::Publisher publisher_;
};

TEST_F(TerrainPlants, AreShapesWhereNearAndAPictureOnTheGroundWhereFar) {
  MadeUpNode node("/grove");
  rviz::Display* const display = show_ground(node, "/grove");
  const auto plants = western_half(0.5F);
  const auto count = static_cast<double>(plants->x.size());
  window_->look_from_above(side / 2, side / 2, 1.5);  // a crown has less than a pixel for its radius
  EXPECT_TRUE(settles(display, [] { return window_->pixel(220, 240) != 0; })) << "a new window is black";
  const std::uint32_t west = window_->pixel(220, 240), east = window_->pixel(420, 240);
  publisher_.publish(plants);
  ASSERT_TRUE(has(display, count));
  window_->run_frames(2);
  keep_picture("plants_far");
  EXPECT_EQ(number(display, "plants"), 0) << "no shapes";
  EXPECT_GT(green_over_red(window_->pixel(220, 240)), green_over_red(west) + 20) << "the cover is seen";
  EXPECT_EQ(window_->pixel(420, 240), east) << "where there are no plants, the ground is as before";
  EXPECT_EQ(window_->pixel(5, 5), window_->pixel(635, 5)) << "and nothing beyond the ground";

  look_from(display, 40);
  keep_picture("plants_near");
  EXPECT_GT(number(display, "plants"), 500);
  EXPECT_LE(number(display, "plants"), 10000) << "Most Plants";
  set(display, {"Plants", "Most Plants"}, 300);
  window_->run_frames(2);
  EXPECT_EQ(number(display, "plants"), 300);

  set(display, {"Plants"}, false);
  window_->look_from_above(side / 2, side / 2, 1.5);
  EXPECT_TRUE(settles(display));
  window_->run_frames(2);
  EXPECT_EQ(number(display, "known_plants"), 0);
  EXPECT_EQ(window_->pixel(220, 240), west) << "the picture is gone";
}

TEST_F(TerrainPlants, OrthographicViewsHaveShapesByTheirScale) {
  MadeUpNode node("/ortho");
  rviz::Display* const display = show_ground(node, "/ortho");
  const auto plants = western_half(0.5F);
  window_->look_from_above(side / 4, side / 2, 20);
  publisher_.publish(plants);
  ASSERT_TRUE(has(display, static_cast<double>(plants->x.size())));
  EXPECT_GT(number(display, "plants"), 500) << "0.5 m are 10 pixels";
  window_->look_from_above(side / 4, side / 2, 2.5);
  EXPECT_EQ(number(display, "plants"), 0) << "0.5 m are 1.25 pixels";
}

TEST_F(TerrainPlants, StayUntilTheNextOnesAreReady) {
  MadeUpNode node("/next");
  rviz::Display* const display = show_ground(node, "/next");
  look_from(display, 40);
  publisher_.publish(western_half(0.5F));
  ASSERT_TRUE(window_->run_until(
      [&] { return number(display, "plants") > 500 && number(display, "waiting_plants") == 0; }));
  set(display, {"Time per Frame"}, 1);  // many frames for the next ones
  const double before = number(display, "plants"), known = number(display, "known_plants");
  int frames_between = 0;
  double fewest = before;
  window_->for_each_frame([&] {
    fewest = std::min(fewest, number(display, "plants"));
    frames_between += number(display, "known_plants") == known && number(display, "waiting_plants") > 1;
  });
  const auto next = western_half(0.6F);
  publisher_.publish(next);
  ASSERT_TRUE(has(display, static_cast<double>(next->x.size())));
  window_->for_each_frame(nullptr);
  EXPECT_GT(frames_between, 1) << "else nothing was shown here";
  EXPECT_GT(fewest, before / 2) << "never none";
}

TEST_F(TerrainPlants, OfBrokenMessagesAreNotDrawnAndHarmNothing) {
  MadeUpNode node("/broken");
  rviz::Display* const display = show_ground(node, "/broken");
  look_from(display, 40);
  const auto good = western_half(0.5F), places = western_half(0.5F), lengths = western_half(0.5F),
             origin = western_half(0.5F);
  for (float& x : places->x) x = std::numeric_limits<float>::quiet_NaN();
  lengths->health.clear();
  origin->origin.position.x = std::numeric_limits<double>::quiet_NaN();
  for (const auto& broken : {places, lengths, origin}) {
    publisher_.publish(good);
    ASSERT_TRUE(has(display, static_cast<double>(good->x.size())));
    publisher_.publish(broken);
    ASSERT_TRUE(has(display, 0));
    EXPECT_EQ(number(display, "plants"), 0);
  }
  publisher_.publish(good);
  ASSERT_TRUE(has(display, static_cast<double>(good->x.size())));
  EXPECT_GT(number(display, "plants"), 500) << "and the next good one is drawn";
}

TEST_F(TerrainPlants, MemoryIsFlatOverMessages) {
  MadeUpNode node("/many");
  rviz::Display* const display = show_ground(node, "/many");
  look_from(display, 100);
  const auto messages = [&](int count) {
    for (int n = 0; n < count; ++n) {
      const auto plants = made_up_plants(20000 + static_cast<std::size_t>(n % 5), side, n);
      publisher_.publish(plants);
      EXPECT_TRUE(has(display, static_cast<double>(plants->x.size())));
    }
  };
  messages(30);
  EXPECT_LT(steady_growth_megabytes([&] { messages(25); }), 3) << "a message has 0.4 MB";
}

}  // namespace
}  // namespace rviz_test

int main(int argc, char** argv) { return rviz_test::run_terrain_tests(argc, argv, "terrain_plants_test"); }
