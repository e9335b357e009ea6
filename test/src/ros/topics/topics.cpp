/// The topics of a paused node on the scenario corner.yaml: what late joiners get, where cells lie, what it
/// costs.
#include <desert_sim/Appearance.h>
#include <desert_sim/ApplySettings.h>
#include <desert_sim/ElevationGrid.h>
#include <desert_sim/ElevationUpdate.h>
#include <desert_sim/SimulationStatus.h>
#include <desert_sim/Step.h>
#include <desert_sim/WindField.h>
#include <image_transport/image_transport.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <std_msgs/Empty.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/transform_listener.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>
#include <map>
#include <set>

#include "include/desert_sim/client/layer_assembler.hpp"
#include "test/support/ros/client.hpp"

namespace {

using namespace desert_sim;
using node_test::call;
using node_test::Listener;
using node_test::wait_until;

constexpr double threshold = 0.01;  // ~update_threshold

bool in_marker(std::uint32_t x, std::uint32_t y) { return x >= 56 && x < 60 && y >= 4 && y < 7; }

Step::Response step(std::uint32_t steps) {
  Step::Request request;
  request.steps = steps;
  const Step::Response response = call<Step>("step", request);
  EXPECT_TRUE(response.success) << response.message;
  return response;
}

double largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
  double largest = a.size() == b.size() ? 0.0 : INFINITY;
  for (std::size_t i = 0; i < a.size() && largest < INFINITY; ++i)
    largest = std::max(largest, std::abs(static_cast<double>(a[i]) - b[i]));
  return largest;
}

TEST(Topics, AStatusComesAtOnceAndSaysWhatRuns) {
  const SimulationStatus status = Listener<SimulationStatus>("status").last();
  EXPECT_EQ(status.state, "paused");
  EXPECT_EQ(status.backend, "cpu");
  EXPECT_FALSE(status.device.empty());
  EXPECT_EQ(status.scenario, "corner");
  EXPECT_EQ(status.header.frame_id, "terrain");
  EXPECT_EQ(status.step_rate, 50);
  EXPECT_EQ(status.steps_per_second, 0);
  EXPECT_EQ(status.lag, 0);
  EXPECT_FLOAT_EQ(static_cast<float>(status.wind_above.x), 5);
  EXPECT_EQ(status.state_hash.size(), 16u);
  bool sand = false;
  for (const MaterialVolume& volume : status.volumes) {
    EXPECT_EQ(volume.residual, 0) << volume.material;
    sand = sand || volume.material == "sand";
  }
  EXPECT_TRUE(sand);
}

TEST(Topics, ALateJoinerGetsAKeyframeWithTheMarkerInTheSouthEast) {
  const ros::Time before = ros::Time::now();
  ASSERT_TRUE(call<std_srvs::Trigger>("reset").success);
  const ros::Time after = ros::Time::now();
  const ElevationGrid grid = Listener<ElevationGrid>("elevation").last();
  EXPECT_EQ(grid.header.frame_id, "terrain");
  EXPECT_GE(grid.header.stamp, before);
  EXPECT_LE(grid.header.stamp, after);
  EXPECT_EQ(grid.step, 0u);
  ASSERT_EQ(grid.width, 64u);
  ASSERT_EQ(grid.height, 48u);
  EXPECT_EQ(grid.cell_size, 2);
  EXPECT_EQ(grid.origin.position.x, 10);
  EXPECT_EQ(grid.origin.position.y, -20);
  EXPECT_EQ(grid.origin.orientation.w, 1);
  ASSERT_EQ(grid.elevation.size(), 64u * 48u);
  for (std::uint32_t y = 0; y < 48; ++y)
    for (std::uint32_t x = 0; x < 64; ++x)
      ASSERT_NEAR(grid.elevation[y * 64 + x], in_marker(x, y) ? 7.5 : 1.5, 1e-5) << "cell " << x << ", " << y;
}

TEST(Topics, AnotherLateJoinerGetsANewKeyframeOfTheSameState) {
  const ElevationGrid first = Listener<ElevationGrid>("elevation").last();
  const ElevationGrid second = Listener<ElevationGrid>("elevation").last();
  EXPECT_GT(second.keyframe, first.keyframe);
  EXPECT_EQ(second.step, first.step);
  EXPECT_EQ(second.elevation, first.elevation);
}

TEST(Topics, WindIsAveragedOverBlocksAndKeepsItsCorner) {
  const WindField wind = Listener<WindField>("wind").last();
  EXPECT_EQ(wind.header.frame_id, "terrain");
  EXPECT_EQ(wind.width, 13u);   // 64 cells in blocks of 5
  EXPECT_EQ(wind.height, 10u);  // 48
  EXPECT_EQ(wind.cell_size, 10);
  EXPECT_EQ(wind.origin.position.x, 10);
  EXPECT_EQ(wind.origin.position.y, -20);
  EXPECT_FLOAT_EQ(static_cast<float>(wind.above.x), 5);
  EXPECT_EQ(wind.above.y, 0);
  ASSERT_EQ(wind.u.size(), 130u);
  ASSERT_EQ(wind.v.size(), 130u);
  for (float u : wind.u) {
    EXPECT_GT(u, 1);
    EXPECT_LT(u, 15);
  }
}

/// Coordinates of UTM in float32 would leave 21 rows of 50 apart.
TEST(Topics, FarTerrainIsShownInTheFrameOfItsMiddle) {
  sensor_msgs::PointCloud2 cloud = Listener<sensor_msgs::PointCloud2>("/far/points").last();
  EXPECT_EQ(cloud.header.frame_id, "far/terrain_center");
  ASSERT_EQ(cloud.width * cloud.height, 64u * 50u);
  std::set<float> columns, rows;
  for (sensor_msgs::PointCloud2ConstIterator<float> x(cloud, "x"); x != x.end(); ++x) {
    columns.insert(x[0]);
    rows.insert(x[1]);
    EXPECT_NEAR(x[2], 0, 1e-3) << "below the mean elevation";
  }
  EXPECT_EQ(columns.size(), 64u);
  EXPECT_EQ(rows.size(), 50u);
  EXPECT_NEAR(*columns.begin(), -6.3, 1e-5);
  EXPECT_NEAR(*rows.rbegin(), 4.9, 1e-5);
  tf2_ros::Buffer buffer;
  tf2_ros::TransformListener listener(buffer);
  ASSERT_TRUE(wait_until([&] { return buffer.canTransform("utm", "far/terrain_center", ros::Time(0)); }));
  const auto middle = buffer.lookupTransform("utm", "far/terrain_center", ros::Time(0)).transform.translation;
  EXPECT_NEAR(middle.x, 500000.25 + 6.4, 1e-6);
  EXPECT_NEAR(middle.y, 5300000.5 + 5, 1e-6);
  EXPECT_NEAR(middle.z, 431.5, 1e-4);
  for (const auto& m : Listener<visualization_msgs::MarkerArray>("/far/wind_markers").last().markers) {
    if (m.action != visualization_msgs::Marker::ADD) continue;
    EXPECT_EQ(m.header.frame_id, "far/terrain_center");
    EXPECT_LT(std::max(std::abs(m.pose.position.x), std::abs(m.pose.position.y)), 6.5) << m.ns;
  }
}

TEST(Topics, PointsLieOnTheSurface) {
  sensor_msgs::PointCloud2 cloud = Listener<sensor_msgs::PointCloud2>("points").last();
  EXPECT_EQ(cloud.header.frame_id, "terrain");
  ASSERT_EQ(cloud.width, 32u);  // every second cell: at most 1000 points
  ASSERT_EQ(cloud.height, 24u);
  ASSERT_EQ(cloud.data.size(), 32u * 24u * cloud.point_step);
  std::set<std::string> fields;
  for (const auto& field : cloud.fields) fields.insert(field.name);
  EXPECT_EQ(fields, (std::set<std::string>{"x", "y", "z", "rgb", "sand", "wind_shadow"}));
  sensor_msgs::PointCloud2ConstIterator<float> x(cloud, "x"), z(cloud, "z"), sand(cloud, "sand");
  sensor_msgs::PointCloud2ConstIterator<std::uint8_t> rgb(cloud, "rgb");  // b, g, r
  int on_marker = 0;
  for (; x != x.end(); ++x, ++z, ++sand, ++rgb) {
    const auto cell_x = static_cast<std::uint32_t>((x[0] - 10) / 2),
               cell_y = static_cast<std::uint32_t>((x[1] + 20) / 2);
    EXPECT_NEAR(x[0], 10 + (cell_x + 0.5) * 2, 1e-5);
    EXPECT_NEAR(z[0], in_marker(cell_x, cell_y) ? 7.5 : 1.5, 1e-5);
    EXPECT_NEAR(sand[0], in_marker(cell_x, cell_y) ? 6.5 : 0.5, 1e-5);
    EXPECT_GT(rgb[2], rgb[0]) << "sand is warm";
    on_marker += in_marker(cell_x, cell_y);
  }
  EXPECT_EQ(on_marker, 2);  // the odd cells of 4 x 3: (57, 5), (59, 5)
}

TEST(Topics, WindMarkersAreFewDistinctAndOverTheGround) {
  using visualization_msgs::Marker;
  const visualization_msgs::MarkerArray array =
      Listener<visualization_msgs::MarkerArray>("wind_markers").last();
  std::set<std::pair<std::string, int>> ids;
  int arrows = 0, texts = 0;
  for (const Marker& marker : array.markers) {
    EXPECT_EQ(marker.header.frame_id, "terrain");
    if (marker.action == Marker::DELETEALL) continue;
    EXPECT_TRUE(ids.insert({marker.ns, marker.id}).second) << marker.ns << " " << marker.id;
    texts += marker.type == Marker::TEXT_VIEW_FACING;
    if (marker.type != Marker::ARROW) continue;
    ++arrows;
    EXPECT_GT(marker.pose.position.x, 10);
    EXPECT_LT(marker.pose.position.x, 138);
    EXPECT_GT(marker.pose.position.y, -20);
    EXPECT_LT(marker.pose.position.y, 76);
    EXPECT_GT(marker.pose.position.z, 1.5);
    EXPECT_GT(marker.scale.x, 0);
    EXPECT_NEAR(2 * std::atan2(marker.pose.orientation.z, marker.pose.orientation.w), 0, 1.0)
        << "it blows east";
  }
  EXPECT_GT(arrows, 30);
  EXPECT_LE(arrows, 100);
  EXPECT_EQ(texts, 1);
}

/// A keyframe of now, for somebody who was sent updates.
void ask_for_keyframe() {
  static const ros::Publisher asks =
      ros::NodeHandle().advertise<std_msgs::Empty>("/desert_sim/request_keyframe", 1);
  ASSERT_TRUE(wait_until([] { return asks.getNumSubscribers() > 0; }));
  asks.publish(std_msgs::Empty());
}

/// The number of the keyframe that the update of a step builds on.
std::uint32_t keyframe_of_update(std::uint64_t step, const Listener<ElevationUpdate>& updates) {
  EXPECT_TRUE(updates.wait_for([&](const ElevationUpdate& u) { return u.step == step; })) << step;
  for (const ElevationUpdate& update : updates.all())
    if (update.step == step) return update.keyframe;
  return 0;
}

/// Steps until the node knows both subscribers and has sent what they are sent when they join: a keyframe no
/// longer comes then between two updates.
void let_node_know(const Listener<ElevationGrid>& keyframes, const Listener<ElevationUpdate>& updates) {
  keyframes.last();
  ASSERT_TRUE(wait_until([&] {
    step(1);
    return updates.count() > 0;
  }));
  ASSERT_TRUE(wait_until([&] {
    const std::uint32_t keyframe = keyframe_of_update(step(1).step, updates);
    return keyframe_of_update(step(1).step, updates) == keyframe;
  }));
}

/// The terrain of step `reached` against the last keyframe before it with all its updates. Makes another
/// step.
void expect_updates_lead_to(std::uint64_t reached, const Listener<ElevationGrid>& keyframes,
                            const Listener<ElevationUpdate>& updates) {
  const std::uint32_t keyframe = keyframe_of_update(reached, updates);
  ask_for_keyframe();
  ASSERT_TRUE(keyframes.wait_for([&](const ElevationGrid& k) { return k.keyframe > keyframe; }));
  ElevationAssembler held;
  ElevationGrid now;
  for (const ElevationGrid& grid : keyframes.all()) {
    if (grid.keyframe == keyframe) held.process(boost::make_shared<ElevationGrid>(grid));
    if (grid.keyframe > keyframe) now = grid;
  }
  ASSERT_EQ(now.step, reached);
  ASSERT_TRUE(held.map()) << "keyframe " << keyframe;
  ASSERT_LT(held.map()->info().step, now.step);
  for (const ElevationUpdate& update : updates.all())
    if (update.keyframe == keyframe) held.process(boost::make_shared<ElevationUpdate>(update));
  ASSERT_EQ(held.need(), KeyframeNeed::none) << held.counts().last_gap;
  EXPECT_EQ(held.map()->info().step, reached);
  EXPECT_LE(largest_difference(held.map()->elevations(), now.elevation), threshold + 1e-6);
  EXPECT_EQ(keyframe_of_update(step(1).step, updates), keyframe + 1)
      << "only the one that was asked for: those who are sent updates need none";
}

TEST(Topics, AFrameStandsInTheMiddleOfTheTerrain) {
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  ASSERT_TRUE(
      wait_until([&] { return buffer.canTransform("terrain", "desert_sim/terrain_center", ros::Time(0)); }));
  const auto center =
      buffer.lookupTransform("terrain", "desert_sim/terrain_center", ros::Time(0)).transform.translation;
  EXPECT_EQ(center.x, 10 + 64);
  EXPECT_EQ(center.y, -20 + 48);
  EXPECT_NEAR(center.z, 1.5 + 6.0 * 12 / (64 * 48), 1e-5);
}

TEST(Topics, TheImageComesThroughImageTransport) {
  image_transport::ImageTransport transport{ros::NodeHandle()};
  const std::vector<std::string> transports = transport.getLoadableTransports();
  std::mutex mutex;
  std::map<std::string, sensor_msgs::Image> images;
  std::vector<image_transport::Subscriber> subscribers;
  for (const std::string name : {"raw", "compressed"}) {
    const boost::function<void(const sensor_msgs::ImageConstPtr&)> take =
        [&images, &mutex, name](const sensor_msgs::ImageConstPtr& image) {
          const std::lock_guard<std::mutex> lock(mutex);
          images[name] = *image;
        };
    const auto subscribe = [&] {
      return transport.subscribe("/desert_sim/image", 1, take, {}, image_transport::TransportHints(name));
    };
    if (std::find(transports.begin(), transports.end(), "image_transport/" + name) != transports.end()) {
      subscribers.push_back(subscribe());
    } else {
      EXPECT_NE(name, "raw");
      EXPECT_THROW(subscribe(), image_transport::TransportLoadException) << "who lacks a transport is told";
    }
  }
  ASSERT_TRUE(wait_until([&] {
    const std::lock_guard<std::mutex> lock(mutex);
    return images.size() == subscribers.size();
  }));
  subscribers.clear();
  for (const auto& [name, image] : images) {
    EXPECT_EQ(image.encoding, "bgr8") << name;
    EXPECT_EQ(image.width * 48, image.height * 64) << name;
    EXPECT_EQ(image.data.size(), 3u * image.width * image.height) << name;
    EXPECT_EQ(image.header.frame_id, "terrain") << name;
  }
}

TEST(Topics, StepPublishesWhatChangedBeforeItAnswers) {
  Listener<ElevationGrid> keyframes("elevation");
  Listener<ElevationUpdate> updates("elevation_updates");
  let_node_know(keyframes, updates);
  for (int round = 0; round < 5; ++round) expect_updates_lead_to(step(3).step, keyframes, updates);
}

TEST(Topics, StepPublishesAKeyframeForThoseWhoListenToKeyframesOnly) {
  Listener<ElevationGrid> keyframes("elevation");
  const std::uint64_t first = keyframes.last().step;
  ASSERT_TRUE(wait_until([&] {
    step(1);
    return keyframes.last().step > first;
  })) << "the node knows that nobody listens to updates any more";
  const std::uint64_t reached = step(3).step;
  EXPECT_TRUE(keyframes.wait_for([&](const ElevationGrid& k) { return k.step == reached; }));
}

TEST(Topics, UpdatesOfARunAddUpToTheNextKeyframe) {
  Listener<ElevationGrid> keyframes("elevation");
  Listener<ElevationUpdate> updates("elevation_updates");
  let_node_know(keyframes, updates);
  const std::size_t first = updates.count();
  EXPECT_TRUE(call<std_srvs::Trigger>("resume").success);
  ASSERT_TRUE(updates.wait_for_count(first + 15));
  EXPECT_TRUE(call<std_srvs::Trigger>("pause").success);
  expect_updates_lead_to(step(0).step, keyframes, updates);
}

/// Copies of the terrain until now, as the status after another step has it.
std::uint64_t copies_after_a_step(const Listener<SimulationStatus>& statuses) {
  const std::uint64_t reached = step(1).step;
  EXPECT_TRUE(wait_until([&] { return statuses.last().step == reached; })) << reached;
  return statuses.last().snapshots;
}
std::uint64_t copied_for_a_step(const Listener<SimulationStatus>& statuses) {
  const std::uint64_t before = copies_after_a_step(statuses);
  return copies_after_a_step(statuses) - before;
}

TEST(Topics, NobodyListensNothingIsCopied) {
  const Listener<SimulationStatus> statuses("status");
  EXPECT_TRUE(wait_until([&] { return copied_for_a_step(statuses) == 0; }))
      << "subscribers of the tests before are gone";
  const std::uint64_t before = copies_after_a_step(statuses);
  EXPECT_TRUE(call<std_srvs::Trigger>("resume").success);
  const std::uint64_t begun = step(0).step;
  EXPECT_TRUE(wait_until([&] { return step(0).step > begun + 20; }));
  EXPECT_TRUE(call<std_srvs::Trigger>("pause").success);
  EXPECT_EQ(copies_after_a_step(statuses), before) << "while it ran";
  Listener<ElevationUpdate> updates("elevation_updates");
  EXPECT_TRUE(wait_until([&] {
    step(1);
    return updates.count() >= 3;
  })) << "updates flow without a subscriber to keyframes";
  EXPECT_GT(copied_for_a_step(statuses), 0u);
}

TEST(Topics, TheAppearanceIsTheScenariosAndFollowsItsSettings) {
  Listener<Appearance> listener("appearance");
  const Appearance first = listener.last();
  EXPECT_FLOAT_EQ(first.sand.r, 0.855f);
  EXPECT_FLOAT_EQ(first.deep_water.b, 0.471f);
  EXPECT_EQ(first.sand.a, 1);
  EXPECT_FALSE(first.wind_arrows);
  const std::string before = step(1).state_hash;
  ApplySettings::Request request;
  request.settings = {"appearance.sand=[0.25, 0.5, 1]", "appearance.wind_arrows=true"};
  const ApplySettings::Response applied = call<ApplySettings>("apply_settings", request);
  EXPECT_TRUE(applied.success) << applied.message;
  EXPECT_TRUE(wait_until([&] {
    const Appearance now = listener.last();
    return now.sand.r == 0.25f && now.sand.g == 0.5f && now.sand.b == 1 && now.wind_arrows;
  }));
  EXPECT_EQ(step(0).state_hash, before) << "the state does not know of it";
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "topics"); }
