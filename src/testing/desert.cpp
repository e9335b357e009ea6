#include <desert_sim/SimulationStatus.h>
#include <std_srvs/Trigger.h>
#include <stdlib.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <filesystem>
#include <thread>

#include "include/desert_sim/testing.hpp"
#include "kernels/view/cell_cost.hpp"
#include "src/core/error.hpp"
#include "src/core/package_folder.hpp"
#include "src/testing/failure_picture.hpp"

namespace desert_sim::test {

namespace fs = std::filesystem;

namespace {

constexpr double start_time = 60;  // [s], times patience(), in which a node has to come up

std::string temporary_folder() {
  std::string path = (fs::temp_directory_path() / "desert_sim_test_XXXXXX").string();
  if (!mkdtemp(path.data())) throw Error(path + ": the folder cannot be made");
  return path;
}

/// Of a YAML file of numbers, and of maps of numbers.
XmlRpc::XmlRpcValue xmlrpc_of(const YAML::Node& node) {
  if (!node.IsMap()) return XmlRpc::XmlRpcValue(node.as<double>());
  XmlRpc::XmlRpcValue map;
  for (const auto& entry : node) map[entry.first.Scalar()] = xmlrpc_of(entry.second);
  return map;
}

/// What lets all maps be exact, and be published by steps alone.
Parameters lockstep_parameters() {
  if (package_folder().empty())
    throw Error(
        "the package desert_sim is not in ROS_PACKAGE_PATH (setup.bash of its workspace puts it there)");
  Parameters parameters;
  for (const auto& entry : YAML::LoadFile(package_folder() + "/config/lockstep_publishers.yaml"))
    parameters[entry.first.Scalar()] = xmlrpc_of(entry.second);
  return parameters;
}

}  // namespace

void Desert::throw_error(const std::string& message) { throw Error(message); }

// ---- begin and end

Desert::Desert(const Options& options) : options_(options), folder_(temporary_folder()) {
  handle_.setCallbackQueue(&queue_);
  spinner_.start();
  if (!options_.scenario.empty()) start_node();
  call<std_srvs::Trigger>("pause");
  TerrainClient::Options client;
  client.node = options_.node;
  client.tell_each_step = true;
  terrain_ = std::make_unique<TerrainClient>(ros::NodeHandle(), client);
  if (!terrain_->wait_for_terrain(start_time * patience()))
    throw Error(options_.node + " sends no elevation");
  if (options_.rover) start_rover();
}

Desert::~Desert() {
  paths_.clear();
  rover_.reset();
  terrain_.reset();
  while (!processes_.empty()) processes_.pop_back();  // the rover's node before that of the desert
  std::error_code ignored;  // what is left in the folder for temporary files harms nobody
  fs::remove_all(folder_, ignored);
}

void Desert::start_node() {
  Parameters parameters = lockstep_parameters();
  parameters["scenario"] = options_.scenario;
  XmlRpc::XmlRpcValue settings;
  settings.setSize(0);
  for (const std::string& setting : options_.settings) settings[settings.size()] = setting;
  if (options_.seed) settings[settings.size()] = "seed=" + std::to_string(*options_.seed);
  parameters["settings"] = settings;
  parameters["backend"] = "cpu";
  parameters["threads"] = 1;
  parameters["paused"] = true;
  parameters["answer_timeout"] = start_time * patience();
  parameters["data_dir"] = folder_;
  for (const auto& [key, value] : options_.parameters) parameters[key] = value;
  processes_.push_back(test::start_node("desert_sim_node", options_.node, parameters));
  wait_for_node(*processes_.back(), options_.node,
                [this] { return ros::service::exists(options_.node + "/step", false); });
}

void Desert::start_rover() {
  const Inbox<SimulationStatus> status(handle_, options_.node + "/status");
  if (!status.wait_for_more_than(0, start_time * patience())) throw Error(options_.node + " sends no status");
  Parameters parameters;
  parameters["clock"] = "lockstep";
  parameters["seconds_per_sim_second"] = options_.seconds_per_step / status.last()->time_step;
  parameters["terrain_node"] = options_.node;
  parameters["tf_prefix"] = options_.rover_name.substr(1);
  parameters["data_dir"] = folder_;
  parameters["x"] = options_.rover->x;
  parameters["y"] = options_.rover->y;
  parameters["yaw_deg"] = options_.rover->yaw_deg;
  parameters["answer_timeout"] = start_time * patience();
  for (const char* sensor : {"lidar", "depth_camera"}) parameters[sensor]["rate"] = 0.0;
  for (const auto& [key, value] : options_.rover_parameters) parameters[key] = value;
  rover_ = std::make_unique<Rover>(handle_, options_.rover_name);
  processes_.push_back(test::start_node("desert_rover_node", rover_->node(), parameters));
  wait_for_node(*processes_.back(), rover_->node(),
                [this] { return rover_->wait_for_stamp(ros::Time(), 0); });
  const Pose start = rover_->pose();
  way_.push_back({start.x, start.y});
}

void Desert::wait_for_node(Process& process, const std::string& name, const std::function<bool()>& is_there) {
  if (wait_until([&] { return is_there() || !process.running(); }, start_time) && process.running()) return;
  throw Error(name + (process.running() ? " gives no sign of life" : " has ended; it has printed why"));
}

// ---- steps and edits

desert_sim::Step::Response Desert::step(std::uint32_t steps) {
  desert_sim::Step::Response answer = show(steps > 0 ? 1 : 0);
  for (std::uint32_t n = 1; n < steps; ++n) answer = show(1);
  return answer;
}

/// Makes 0 or 1 steps, and waits until terrain and rover are there.
desert_sim::Step::Response Desert::show(std::uint32_t steps) {
  if (rover_) commands_seen_ = rover_->status().commands;
  desert_sim::Step::Request request;
  request.steps = steps;
  const auto answer = call<desert_sim::Step>("step", request);
  const std::string step = "step " + std::to_string(answer.step);
  if (!terrain_->wait_for_step(answer.step, start_time * patience()))
    throw Error("the elevation of " + step + " does not come");
  if (!rover_) return answer;
  const ros::Time stamp = terrain_->map()->info().stamp;
  const auto of_this_state = [stamp](const RoverStatus& s) { return s.terrain_stamp >= stamp; };
  if (!rover_->wait_for_stamp(stamp, start_time * patience()) ||
      !rover_->wait_for_status(of_this_state, start_time * patience()))
    throw Error("the rover does not come to " + step);
  const Pose now = rover_->pose();
  way_.push_back({now.x, now.y});
  return answer;
}

desert_sim::EditTerrain::Response Desert::edit(const desert_sim::EditTerrain::Request& request) {
  const auto answer = call<desert_sim::EditTerrain>("edit_terrain", request);
  show(0);
  return answer;
}

Rover& Desert::rover() {
  if (!rover_) throw Error("this desert has no rover: Options::rover is empty");
  return *rover_;
}

std::vector<std::int8_t> Desert::costs(const Point& center, double length_x, double length_y) const {
  desert_sim::GetSubmap::Request request;
  request.center.x = center.x;
  request.center.y = center.y;
  request.length_x = length_x;
  request.length_y = length_y;
  request.layers = {"traversability"};
  const auto answer = call<desert_sim::GetSubmap>("get_submap", request);
  std::vector<std::int8_t> costs;
  for (const float t : answer.map.layers.at(0).data) costs.push_back(cell_cost::of(t));
  return costs;
}

int Desert::cost(const Point& p) const {
  const std::shared_ptr<const ElevationMap> map = terrain_->map();
  const std::optional<LayerMap::Cell> cell = map->cell_of(p.x, p.y);
  if (!cell)
    throw Error("the point (" + std::to_string(p.x) + ", " + std::to_string(p.y) + ") is off the grid");
  const geometry_msgs::Point center = map->center_of(*cell);
  return costs({center.x, center.y}, map->info().cell_size, map->info().cell_size).at(0);
}

const Inbox<nav_msgs::Path>& Desert::inbox(const std::string& topic) {
  std::unique_ptr<Inbox<nav_msgs::Path>>& inbox = paths_[topic];
  if (!inbox) inbox = std::make_unique<Inbox<nav_msgs::Path>>(handle_, topic);
  return *inbox;
}

void Desert::write_picture(const std::string& path, const std::optional<Point>& goal) const {
  const std::shared_ptr<const ElevationMap> map = terrain_->map();
  const MapInfo& grid = map->info();
  const double length_x = grid.width * grid.cell_size, length_y = grid.height * grid.cell_size;
  FailurePicture picture{
      map,          costs({grid.origin_x + length_x / 2, grid.origin_y + length_y / 2}, length_x, length_y),
      way_,         {},
      std::nullopt, goal};
  for (const auto& [topic, inbox] : paths_)
    if (const auto last = inbox->last()) picture.paths.push_back(points_of(*last));
  if (rover_) picture.rover = rover_->pose();
  write_failure_picture(path, picture);
}

}  // namespace desert_sim::test
