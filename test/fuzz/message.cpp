// Messages and requests that the node takes, as a sequence from one input: each is refused, or applied to a
// small simulation. What was applied can be saved, loaded, and replayed from its form in the journal.
#include <console_bridge/console.h>
#include <desert_sim/GetSubmap.h>
#include <desert_sim/QueryTerrain.h>
#include <tf2_msgs/TFMessage.h>
#include <yaml-cpp/yaml.h>

#include "src/core/log.hpp"
#include "src/ros/conversion/grid_map_message.hpp"
#include "src/ros/forecast/forecast_request.hpp"
#include "src/ros/parameters/reconfigure_messages.hpp"
#include "src/ros/services/requests.hpp"
#include "src/ros/services/terrain_sampler.hpp"
#include "src/simulation/checkpoint.hpp"
#include "src/simulation/commands/command_yaml.hpp"
#include "src/simulation/session.hpp"
#include "test/fuzz/fuzz.hpp"
#include "test/fuzz/message_source.hpp"
#include "test/support/ros/request_fields.hpp"
#include "test/support/small_scenarios.hpp"

namespace desert_sim {
namespace {

using node_test::without_unused_fields;
using Words = std::vector<std::string>;
const Words frame_words{"", "map", "rover", "/rover", "tilted", "far", "nowhere", "", "map"};
const Words terrain_words{"",       "rover",   "tilted",    "sand",    "bedrock", "soil",   "water",
                          "circle", "ellipse", "rectangle", "capsule", "polygon", "patch",  "add",
                          "sub",    "replace", "min",       "max",     "avg",     "smooth", "heights",
                          "mask",   "mono8",   "mono16",    "32FC1"};
const Words plant_words{"",       "rover",   "plant",     "clear",   "bush",   "tree",
                        "circle", "ellipse", "rectangle", "capsule", "polygon"};
const Words wind_words{"",      "rover",  "add", "change",     "remove",
                       "clear", "vortex", "jet", "turbulence", "sink"};
const Words schedule_words{"timeline", "rose"};
const Words weather_words{"rain_rate", "rain_share", "evaporation",   "ground_evaporation",
                          "sea",       "sea_level",  "wave_strength", "wave_period",
                          "springs",   "none",       "border",        "everywhere"};
const Words forecast_words{"timeline", "rose", "constant", "", "wind__speed", "step_rate"};
const Words layer_words{"", "rover", "elevation", "slope", "traversability", "plants", "wind_x", "roughness"};
const Words reconfigure_words{"wind__speed", "grid_map_layers", "[1, 2]", "true",
                              "x: [\n# {",   "border",          "sweeps", "fast"};

geometry_msgs::TransformStamped static_frame(const char* name, double x, double roll_sine,
                                             double roll_cosine) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "map";
  transform.child_frame_id = name;
  transform.transform.translation.x = x;
  transform.transform.rotation.x = roll_sine;
  transform.transform.rotation.w = roll_cosine;
  return transform;
}

Scenario resolved(const char* yaml) {
  Scenario scenario = parse_scenario_text(yaml, "fuzz");
  resolve_grid(scenario, no_raster_loader);
  return scenario;
}

/// A node without threads and without ROS.
class Node {
 public:
  explicit Node(const Scenario& scenario)
      : scenario_(scenario), session_(scenario_, no_raster_loader, "cpu", 1) {
    frames_.add(static_frame("rover", 3, 0, 1), "fuzz", true);
    frames_.add(static_frame("tilted", 0, 0.6, 0.8), "fuzz", true);
    frames_.add(static_frame("far", 1e300, 0, 1), "fuzz", true);
  }

  void take(FuzzedDataProvider& data) {
    switch (data.ConsumeIntegralInRange(0, 12)) {
      case 0:
        return apply(
            without_unused_fields(fuzz::next_message<SetWindRequest>(data, frame_words), wind_command));
      case 1:
        return apply(without_unused_fields(
            tidy(fuzz::next_message<SetWindScheduleRequest>(data, schedule_words)), wind_schedule_command));
      case 2:
        return apply(without_unused_fields(fuzz::next_message<EditWindRequest>(data, wind_words),
                                           [&](const auto& r) { return wind_edit_command(r, frames_); }));
      case 3:
        return apply(without_unused_fields(fuzz::next_message<SetWeatherRequest>(data, weather_words),
                                           weather_command));
      case 4:
        return apply(
            cmd_wind_command(fuzz::next_message<geometry_msgs::Vector3Stamped>(data, frame_words), frames_));
      case 5:
        return apply(without_unused_fields(fuzz::next_message<EditPlantsRequest>(data, plant_words),
                                           [&](const auto& r) { return plants_command(r, frames_); }));
      case 6:
        return reconfigure(data);
      case 7:
        return query(fuzz::next_message<QueryTerrainRequest>(data, frame_words));
      case 8:
        return cut(fuzz::next_message<GetSubmapRequest>(data, layer_words));
      case 9:
        return fuzz::hear_transforms(fuzz::next_message<tf2_msgs::TFMessage>(data, frame_words),
                                     [this](const auto& t) { frames_.add(t, "fuzz", false); });
      case 10:
        return step();
      case 11:
        return forecast(data);
      default:
        return edit_terrain(data);
    }
  }

  /// Aborts unless the state can be saved, loaded and saved as the same, and replaying leads to it.
  void expect_repeatable() {
    Simulation& live = session_.simulation();
    const std::string saved = checkpoint_bytes(live);
    const fuzz::MemoryFile file(saved.data(), saved.size());
    Session replayed(scenario_, no_raster_loader, "cpu", 1);
    try {
      const std::unique_ptr<Simulation> loaded = load_checkpoint(file.path(), live.exec());
      if (loaded->state().hash() != live.state().hash() || checkpoint_bytes(*loaded) != saved) std::abort();
      for (const std::string& entry : journal_) {
        if (entry.empty())
          replayed.step();
        else
          replayed.apply(read_command(YAML::Load(entry), "journal"));
      }
    } catch (const ConfigError& e) {
      std::fprintf(stderr, "refused what had been accepted: %s\n", e.what());
      std::abort();
    }
    if (replayed.simulation().state().hash() != live.state().hash()) std::abort();
  }

 private:
  void apply(const Command& command) {
    session_.apply(command);
    YAML::Emitter entry;
    entry << YAML::BeginMap;
    emit_command(entry, command);
    entry << YAML::EndMap;
    journal_.push_back(entry.c_str());
  }
  void step() {
    session_.step();
    journal_.emplace_back();
  }

  /// Without the fields of segments that its kind does not use.
  static SetWindScheduleRequest tidy(SetWindScheduleRequest request) {
    for (WindScheduleSegment& segment : request.segments)
      if (request.kind == "rose")
        segment.duration = segment.ramp = 0;
      else
        segment.probability = 0;
    return request;
  }

  void edit_terrain(FuzzedDataProvider& data) {
    auto request = fuzz::next_message<EditTerrainRequest>(data, terrain_words);
    if (data.ConsumeBool()) {  // the image's fields fit together
      request.image.step = request.image.width * (request.image.encoding == "32FC1" ? 4 : 2);
      if (std::uint64_t{request.image.step} * request.image.height > 4096) return;
      request.image.data = data.ConsumeBytes<std::uint8_t>(request.image.step * request.image.height);
      request.image.data.resize(request.image.step * request.image.height);
    }
    apply(without_unused_fields(request, [&](const auto& r) { return edit_command(r, frames_); }));
  }

  void reconfigure(FuzzedDataProvider& data) {
    LiveParameters present{session_.simulation().state().present_scenario(), publishers_, 0};
    auto request = fuzz::next_message<dynamic_reconfigure::Config>(data, reconfigure_words);
    if (data.ConsumeBool()) rename(request.bools, reconfigure_values(present).bools, data);
    if (data.ConsumeBool()) rename(request.ints, reconfigure_values(present).ints, data);
    if (data.ConsumeBool()) rename(request.strs, reconfigure_values(present).strs, data);
    if (data.ConsumeBool()) rename(request.doubles, reconfigure_values(present).doubles, data);
    const LiveChange change = reconfigure_change(request, present);
    if (!change.settings.empty()) apply(command::SetParameters{change.settings});
    publishers_ = change.publishers;
  }
  /// Gives each entry the name of a parameter that there is.
  template <class Entries>
  static void rename(Entries& entries, const Entries& known, FuzzedDataProvider& data) {
    for (auto& entry : entries)
      entry.name = known[data.ConsumeIntegralInRange<std::size_t>(0, known.size() - 1)].name;
  }

  void query(const QueryTerrainRequest& request) {
    const tf2::Transform transform = frames_.to_terrain(request.header);
    const std::shared_ptr<const Snapshot> snapshot = session_.simulation().views().snapshot(sampled_layers());
    const TerrainSampler sampler(*snapshot);
    for (const geometry_msgs::Point& point : request.points) {
      const tf2::Vector3 p = transform * tf2::Vector3(point.x, point.y, point.z);
      sampler.at(p.x(), p.y());
    }
  }

  void cut(const GetSubmapRequest& request) {
    const std::vector<MapLayer> layers = map_layers_named(request.layers, "layers");
    const tf2::Vector3 center = frames_.to_terrain(request.header) *
                                tf2::Vector3(request.center.x, request.center.y, request.center.z);
    const MapRegion region{center.x(), center.y(), request.length_x, request.length_y};
    const TerrainState state{{}, session_.simulation().views().snapshot(layers_of(layers)), {}, {}, {}, {}};
    const MapWindow window = window_of(region, *state.snapshot);
    require_inside(window, region, *state.snapshot);
    require_map_size(window, layers.size(), "region");
    terrain_submap(state, "map", layers, window);
    grid_map(state, "map", layers, window, 3);
  }

  void forecast(FuzzedDataProvider& data) {
    auto goal = fuzz::next_message<ForecastTerrainGoal>(data, forecast_words);
    if (data.ConsumeBool()) {  // a short one
      goal.horizon = data.ConsumeIntegralInRange(1, 4);
      goal.moments = data.ConsumeIntegralInRange(1u, 4u);
      goal.members = data.ConsumeIntegralInRange(0u, 3u);
      goal.stride = data.ConsumeIntegralInRange(0u, 3u);
    }
    if (data.ConsumeBool()) goal.parameters = {};
    if (goal.wind.empty() || data.ConsumeBool()) {
      goal.wind.clear();
      goal.wind_kind.clear();
      goal.wind_repeat = 0;
      goal.wind_hold_time = 0;
      goal.wind_seed = 0;
    }
    if (goal.members < 2) goal.gust_speed = goal.gust_direction_deg = goal.gust_time = 0, goal.seed = 0;
    const LiveParameters present{session_.simulation().state().present_scenario(), publishers_, 10};
    const ForecastOptions options = forecast_options(goal, present, 10);
    const std::uint64_t before = session_.simulation().state().hash();
    ForecastRun run(checkpoint_bytes(session_.simulation()), options, "cpu", 1);
    int steps = 0;
    run.run([&steps](int, double) { return ++steps <= 20; });
    if (session_.simulation().state().hash() != before) std::abort();
  }

  const Scenario& scenario_;
  Session session_;
  TerrainTransforms frames_{"map"};
  PublisherSetup publishers_;
  std::vector<std::string> journal_;  ///< commands in YAML; empty: a step
};

}  // namespace
}  // namespace desert_sim

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace desert_sim;
  console_bridge::noOutputHandler();
  set_log_sink([](Severity, const std::string&) {});
  static const Scenario oasis = resolved(test::small_oasis), desert = resolved(test::small_desert);
  FuzzedDataProvider data(bytes, size);
  Node node(data.ConsumeBool() ? oasis : desert);
  const bool repeat = data.ConsumeIntegralInRange(0, 3) == 0;  // takes five times as long as all the rest
  fuzz::take_messages(data, 16, [&] { node.take(data); });
  if (repeat) node.expect_repeatable();
  return 0;
}
