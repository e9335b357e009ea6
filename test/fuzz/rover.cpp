// Messages and requests that the node of a rover takes, as a sequence from one input: each is refused, or the
// rover obeys and drives on the ground that it was told of; its state can be saved and loaded.
#include <desert_sim/DriveRover.h>
#include <desert_sim/SetRoverPose.h>
#include <geometry_msgs/Twist.h>
#include <xxhash.h>

#include <cmath>
#include <cstring>

#include "src/core/log.hpp"
#include "src/rover/grid_ground.hpp"
#include "src/rover/state_file.hpp"
#include "src/simulation/session.hpp"
#include "test/fuzz/fuzz.hpp"
#include "test/fuzz/message_source.hpp"
#include "test/support/ros/terrain_maps.hpp"
#include "test/support/small_scenarios.hpp"

namespace desert_sim {
namespace {

const std::vector<std::string> words{"map", "elevation", "looseness", "water_depth", ""};

TerrainState small_terrain() {
  Scenario scenario = parse_scenario_text(test::small_desert, "fuzz");
  resolve_grid(scenario, no_raster_loader);
  Session session(scenario, no_raster_loader, "cpu", 1);
  session.step();
  TerrainState state;
  state.snapshot = session.simulation().views().snapshot(GridGround::layers_of_snapshot(true));
  return state;
}

/// The node of a rover without threads and without ROS.
class Node {
 public:
  explicit Node(const TerrainState& terrain)
      : terrain_(terrain), maps_(node_test::maps_of(terrain)), rover_(RoverParameters(), {}, "fuzz") {
    rover_.reset(8, 6, 0, ground());
  }

  void take(FuzzedDataProvider& data) {
    switch (data.ConsumeIntegralInRange(0, 7)) {
      case 0: {
        const auto m = fuzz::next_message<geometry_msgs::Twist>(data, words);
        return rover_.drive({m.linear.x, m.linear.y, m.angular.z}, 0.5);
      }
      case 1: {
        const auto m = fuzz::next_message<DriveRoverRequest>(data, words);
        return rover_.drive({m.twist.linear.x, m.twist.linear.y, m.twist.angular.z}, m.seconds);
      }
      case 2: {
        const auto m = fuzz::next_message<SetRoverPoseRequest>(data, words);
        return rover_.place(m.pose.x, m.pose.y, m.pose.theta, ground());
      }
      case 3:
        return take_layer(data);
      case 4: {
        const auto m = fuzz::next_message<MicroReliefState>(data, words);
        maps_.micro_relief_settings = std::make_shared<const Snapshot>(snapshot_of(m));
        return;
      }
      case 5:
        return load(data);
      case 6: {
        auto m = fuzz::next_message<Plants>(data, words);
        if (data.ConsumeBool()) {  // else most are refused
          m.origin.position.x = terrain_.snapshot->origin_x;
          m.origin.position.y = terrain_.snapshot->origin_y;
          m.y.resize(m.x.size());
          m.radius.resize(m.x.size());
        }
        maps_.plants = std::make_shared<const MapPlants>(boost::make_shared<Plants>(m));
        return;
      }
      default: {
        const MapGround now = ground();
        rover_.advance(data.ConsumeFloatingPointInRange(0.0, 0.2), &now);
      }
    }
  }

  /// Aborts unless the state can be saved and loaded as the same.
  void expect_saved() {
    const std::string saved = rover_state_bytes(rover_);
    try {
      rover_.set_state(rover_state_of(saved, rover_, "fuzz"));
    } catch (const ConfigError& e) {
      std::fprintf(stderr, "refused what was saved: %s\n", e.what());
      std::abort();
    }
    if (rover_state_bytes(rover_) != saved) std::abort();
  }

 private:
  MapGround ground() const { return {maps_, 0.3, 1, true}; }

  /// A map of one of the layers: any message, or one that fits the others.
  void take_layer(FuzzedDataProvider& data) {
    const std::size_t which = data.ConsumeIntegralInRange<std::size_t>(0, TerrainMaps::count - 1);
    auto grid = boost::make_shared<LayerGrid>(fuzz::next_message<LayerGrid>(data, words));
    if (data.ConsumeBool()) {
      const std::vector<float> values = grid->data;
      grid = node_test::keyframe_of(*terrain_.snapshot, TerrainMaps::rows[which].name);
      std::copy_n(values.begin(), std::min(values.size(), grid->data.size()), grid->data.begin());
    }
    LayerAssembler assembler;
    const MapChange change = assembler.process(LayerGrid::ConstPtr(grid));
    if (change.map) maps_.set(which, change);
  }

  /// A state with some bytes changed, and the right checksum.
  void load(FuzzedDataProvider& data) {
    std::string bytes = rover_state_bytes(rover_);
    const std::size_t body = bytes.size() - sizeof(XXH64_hash_t);
    for (int n = data.ConsumeIntegralInRange(0, 8); n > 0; --n)
      bytes[data.ConsumeIntegralInRange<std::size_t>(0, body - 1)] = data.ConsumeIntegral<char>();
    const XXH64_hash_t checksum = XXH3_64bits(bytes.data(), body);
    std::memcpy(&bytes[body], &checksum, sizeof checksum);
    rover_.set_state(rover_state_of(bytes, rover_, "fuzz"));
  }

  const TerrainState& terrain_;
  TerrainMaps maps_;
  Rover rover_;
};

}  // namespace
}  // namespace desert_sim

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace desert_sim;
  set_log_sink([](Severity, const std::string&) {});
  static const TerrainState terrain = small_terrain();
  FuzzedDataProvider data(bytes, size);
  Node node(terrain);
  fuzz::take_messages(data, 24, [&] { node.take(data); });
  node.expect_saved();
  return 0;
}
