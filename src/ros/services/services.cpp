#include "src/ros/services/services.hpp"

#include <ros/console.h>
#include <ros/service_callback_helper.h>

#include <boost/make_shared.hpp>

#include "src/core/quoted.hpp"
#include "src/ros/conversion/messages.hpp"
#include "src/ros/services/requests.hpp"
#include "src/ros/services/terrain_formats.hpp"
#include "src/ros/services/terrain_sampler.hpp"
#include "src/scenario/band_terrain.hpp"

namespace desert_sim {

namespace {

constexpr std::size_t most_points = 1000000;
constexpr const char* terrain_file = "terrain.yaml";  // in a saved terrain's folder
constexpr auto recent_enough = std::chrono::milliseconds(100);

/// ~get_grid_map: a refusal is a call that fails, with its reason. call() must return true all the same:
/// roscpp sends what is in `response`, whose first byte tells the client, and puts no reason into failures of
/// its own.
class GridMapCallback : public ros::ServiceCallbackHelper {
 public:
  explicit GridMapCallback(const Submaps& submaps) : submaps_(submaps) {}

  bool call(ros::ServiceCallbackHelperCallParams& params) override {
    try {
      GetGridMapRequest request;
      ros::serialization::deserializeMessage(params.request, request);
      GetGridMapResponse response;
      response.map = submaps_.get(request);
      params.response = ros::serialization::serializeServiceResponse(true, response);
      return true;
    } catch (const ConfigError& e) {
      params.response = ros::serialization::serializeServiceResponse(false, std::string(e.what()));
    } catch (const std::exception& e) {
      ROS_ERROR("get_grid_map: %s", e.what());
      params.response = ros::serialization::serializeServiceResponse(false, std::string(e.what()));
    }
    return true;
  }

 private:
  const Submaps& submaps_;
};

}  // namespace

template <class Service>
void Services::advertise(const std::string& name,
                         void (Services::*serve)(const typename Service::Request&,
                                                 typename Service::Response&),
                         ros::CallbackQueue* queue) {
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  const boost::function<bool(Request&, Response&)> callback = [this, name, serve](Request& request,
                                                                                  Response& response) {
    try {
      (this->*serve)(request, response);
      response.success = true;
    } catch (const ConfigError& e) {
      response.success = false;
      response.message = e.what();
    } catch (const std::exception& e) {
      ROS_ERROR("%s: %s", name.c_str(), e.what());
      response.success = false;
      response.message = e.what();
    }
    return true;  // the answer, with its reason, is to reach who asked
  };
  auto options = ros::AdvertiseServiceOptions::create<Service>(name, callback, ros::VoidConstPtr(), queue);
  servers_.push_back(node_.advertiseService(options));
}

Services::Services(ros::NodeHandle node, ros::CallbackQueue& step_queue, SimulationThread& simulation,
                   Topics& topics, Frames& frames, const DataFolder& files)
    : node_(std::move(node)),
      simulation_(simulation),
      topics_(topics),
      frames_(frames),
      files_(files),
      submaps_(simulation, frames) {
  // Commands of the same names are in the namespace `command`.
  advertise<desert_sim::SetWind>("set_wind", &Services::set_wind);
  advertise<desert_sim::SetWindSchedule>("set_wind_schedule", &Services::set_wind_schedule);
  advertise<desert_sim::SetWeather>("set_weather", &Services::set_weather);
  advertise<desert_sim::EditWind>("edit_wind", &Services::edit_wind);
  advertise<desert_sim::EditPlants>("edit_plants", &Services::edit_plants);
  advertise<desert_sim::EditTerrain>("edit_terrain", &Services::edit_terrain);
  advertise<desert_sim::QueryTerrain>("query_terrain", &Services::query_terrain);
  advertise<desert_sim::GetSubmap>("get_submap", &Services::get_submap);
  advertise_grid_map();
  advertise<desert_sim::Step>("step", &Services::step, &step_queue);
  advertise<std_srvs::Trigger>("pause", &Services::pause);
  advertise<std_srvs::Trigger>("resume", &Services::resume);
  advertise<std_srvs::Trigger>("reset", &Services::reset);
  advertise<desert_sim::SaveCheckpoint>("save_checkpoint", &Services::save_checkpoint);
  advertise<desert_sim::LoadCheckpoint>("load_checkpoint", &Services::load_checkpoint);
  advertise<desert_sim::SaveTerrain>("save_terrain", &Services::save_terrain);
  advertise<desert_sim::LoadTerrain>("load_terrain", &Services::load_terrain);
  advertise<desert_sim::LoadScenario>("load_scenario", &Services::load_scenario);
}

void Services::set_wind(const SetWindRequest& request, SetWindResponse&) {
  simulation_.apply(wind_command(request)).get();
  topics_.status_changed();
}

void Services::set_wind_schedule(const SetWindScheduleRequest& request, SetWindScheduleResponse&) {
  simulation_.apply(schedule_command(request)).get();
  topics_.status_changed();
}

void Services::set_weather(const SetWeatherRequest& request, SetWeatherResponse&) {
  simulation_.apply(weather_command(request)).get();
  topics_.status_changed();
}

void Services::edit_wind(const EditWindRequest& request, EditWindResponse&) {
  simulation_.apply(wind_edit_command(request, frames_)).get();
  topics_.status_changed();
}

void Services::edit_plants(const EditPlantsRequest& request, EditPlantsResponse& response) {
  const Reached reached = simulation_.apply(plants_command(request, frames_)).get();
  response.plants = reached.result.plants;
  response.step = reached.moment.step;
  topics_.status_changed();
}

void Services::edit_terrain(const EditTerrainRequest& request, EditTerrainResponse& response) {
  const bool diff = topics_.diff_wanted();
  const Reached reached = simulation_.apply(edit_command(request, frames_), false, diff).get();
  if (diff) topics_.publish_diff(reached);
  const CellRectangle& touched = reached.result.touched;
  response.volume = reached.result.volume_m3;
  response.moved = reached.result.moved_m3;
  response.x = static_cast<std::uint32_t>(touched.x0);
  response.y = static_cast<std::uint32_t>(touched.y0);
  response.width = static_cast<std::uint32_t>(touched.x1 - touched.x0);
  response.height = static_cast<std::uint32_t>(touched.y1 - touched.y0);
  response.step = reached.moment.step;
  topics_.status_changed();
}

TerrainState Services::recent_terrain() {
  {
    const std::lock_guard<std::mutex> lock(recent_mutex_);
    const bool unchanged = recent_.moment.change == simulation_.changes();
    const bool uncommanded = recent_.moment.command == simulation_.commands();
    const bool recent = std::chrono::steady_clock::now() - recent_time_ < recent_enough;
    if (recent_.snapshot && (unchanged || (uncommanded && recent))) return recent_;
  }
  const TerrainState state = simulation_.terrain(sampled_layers()).get();
  const std::lock_guard<std::mutex> lock(recent_mutex_);
  recent_ = state;
  recent_time_ = std::chrono::steady_clock::now();
  return state;
}

void Services::query_terrain(const QueryTerrainRequest& request, QueryTerrainResponse& response) {
  if (request.points.size() > most_points)
    throw ConfigError("points: " + std::to_string(request.points.size()) + " are more than " +
                      std::to_string(most_points));
  for (std::size_t n = 0; n < request.points.size(); ++n)
    require_finite(request.points[n], "points[" + std::to_string(n) + "]");
  const tf2::Transform transform = frames_.to_terrain(request.header);
  const TerrainState state = recent_terrain();
  const TerrainSampler sampler(*state.snapshot);
  response.samples.reserve(request.points.size());
  for (const geometry_msgs::Point& point : request.points) {
    const tf2::Vector3 p = transform * tf2::Vector3(point.x, point.y, point.z);
    response.samples.push_back(sampler.at(p.x(), p.y()));
  }
  response.header = header_of(state.moment, frames_.terrain_frame());
  response.step = state.moment.step;
  response.sim_time = state.moment.time;
}

void Services::get_submap(const GetSubmapRequest& request, GetSubmapResponse& response) {
  response.map = submaps_.get(request);
}

/// The answer of GetGridMap has no room for a reason; a call that fails has, and clients show it.
void Services::advertise_grid_map() {
  ros::AdvertiseServiceOptions options;
  options.init<GetGridMap>("get_grid_map", [](GetGridMapRequest&, GetGridMapResponse&) { return false; });
  options.helper = boost::make_shared<GridMapCallback>(submaps_);
  servers_.push_back(node_.advertiseService(options));
}

void Services::step(const StepRequest& request, StepResponse& response) {
  const Reached reached = simulation_.step(request.steps).get();
  topics_.publish_now();
  response.step = reached.moment.step;
  response.sim_time = reached.moment.time;
  response.state_hash = hash_text(reached.hash);
}

void Services::pause(const std_srvs::TriggerRequest&, std_srvs::TriggerResponse&) {
  simulation_.pause().get();
  topics_.publish_now();
}

void Services::resume(const std_srvs::TriggerRequest&, std_srvs::TriggerResponse&) {
  simulation_.resume().get();
  topics_.status_changed();
}

void Services::reset(const std_srvs::TriggerRequest&, std_srvs::TriggerResponse&) {
  simulation_.apply(command::Reset{}).get();
  ROS_INFO("reset to the scenario's start");
  topics_.publish_now();
}

void Services::save_checkpoint(const SaveCheckpointRequest& request, SaveCheckpointResponse& response) {
  response.path = files_.for_writing(request.name);
  const Reached reached = simulation_.save_checkpoint(response.path).get();
  response.step = reached.moment.step;
  response.state_hash = hash_text(reached.hash);
  ROS_INFO("saved step %lu to %s", static_cast<unsigned long>(response.step), response.path.c_str());
}

void Services::load_checkpoint(const LoadCheckpointRequest& request, LoadCheckpointResponse& response) {
  const std::string path = files_.for_reading(request.name);
  const Reached reached = simulation_.apply(command::LoadCheckpoint{path, 0}, true).get();
  response.step = reached.moment.step;
  response.sim_time = reached.moment.time;
  response.state_hash = hash_text(reached.hash);
  ROS_INFO("loaded step %lu from %s", static_cast<unsigned long>(response.step), path.c_str());
  terrain_replaced();
}

void Services::terrain_replaced() {
  if (frames_.has_center()) {
    // One after another, each with a copy of its own: the last one to move it has seen the newest terrain.
    const std::lock_guard<std::mutex> lock(center_mutex_);
    frames_.move_center(*simulation_.terrain({Layer::elevation}).get().snapshot);
  }
  topics_.publish_now();
}

void Services::save_terrain(const SaveTerrainRequest& request, SaveTerrainResponse& response) {
  const TerrainFormat format = terrain_format(request.format);
  if (is_bag(request.name))
    throw ConfigError("name: " + quoted(request.name) + " ends in .bag, which load_terrain takes for a file");
  response.path = files_.for_writing(request.name + "/" + terrain_file);
  const TerrainToSave terrain = simulation_.terrain_to_save().get();
  const LayerWriter writer =
      layer_writer(format, terrain, frames_.terrain_frame(), node_.resolveName("grid_map"));
  desert_sim::save_terrain(response.path, terrain.scenario, *terrain.state.snapshot, writer,
                           hash_text(terrain.hash));
  response.step = terrain.state.moment.step;
  ROS_INFO("saved the terrain of step %lu to %s", static_cast<unsigned long>(response.step),
           response.path.c_str());
}

void Services::load_terrain(const LoadTerrainRequest& request, LoadTerrainResponse& response) {
  const std::string name = is_bag(request.name) ? request.name : request.name + "/" + terrain_file;
  response.state_hash = begin({files_.for_reading(name), true, 0, request.fill_nodata != 0});
}

void Services::load_scenario(const LoadScenarioRequest& request, LoadScenarioResponse& response) {
  response.state_hash = begin({files_.for_reading(request.name), false, 0, false});
}

std::string Services::begin(const command::LoadScenario& command) {
  const Reached reached = simulation_.apply(command, true).get();
  ROS_INFO("loaded %s", command.path.c_str());
  terrain_replaced();
  return hash_text(reached.hash);
}

}  // namespace desert_sim
