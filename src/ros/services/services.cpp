#include "src/ros/services/services.hpp"

#include <ros/console.h>

#include <boost/make_shared.hpp>

#include "src/core/did_you_mean.hpp"
#include "src/core/hash_text.hpp"
#include "src/core/joined.hpp"
#include "src/core/quoted.hpp"
#include "src/ros/conversion/messages.hpp"
#include "src/ros/services/answer.hpp"
#include "src/ros/services/requests.hpp"
#include "src/ros/services/terrain_formats.hpp"
#include "src/scenario/band_terrain.hpp"
#include "src/scenario/scenario_file.hpp"

namespace desert_sim {

template <class Service>
void Services::advertise(const std::string& name,
                         void (Services::*serve)(const typename Service::Request&,
                                                 typename Service::Response&),
                         ros::CallbackQueue* queue) {
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  const boost::function<bool(Request&, Response&)> callback = [this, name, serve](Request& request,
                                                                                  Response& response) {
    const SimulationThread::Patience patience(answer_timeout_);
    return answer(name, response, [&] { (this->*serve)(request, response); });
  };
  auto options = ros::AdvertiseServiceOptions::create<Service>(name, callback, ros::VoidConstPtr(), queue);
  servers_.push_back(node_.advertiseService(options));
}

/// The table of services: type, name, and what serves it. (~set_parameters is in reconfigure.cpp,
/// ~reload_parameters in reload_parameters.cpp.) `desert_sim::` distinguishes a type from the command of that
/// name.
void Services::advertise_all(ros::CallbackQueue& step_queue) {
  advertise<desert_sim::SetWind>("set_wind", &Services::set_wind);
  advertise<desert_sim::SetWindSchedule>("set_wind_schedule", &Services::set_wind_schedule);
  advertise<desert_sim::SetWeather>("set_weather", &Services::set_weather);
  advertise<desert_sim::EditWind>("edit_wind", &Services::edit_wind);
  advertise<desert_sim::EditPlants>("edit_plants", &Services::edit_plants);
  advertise<desert_sim::EditTerrain>("edit_terrain", &Services::edit_terrain);
  advertise<desert_sim::Undo>("undo", &Services::undo);
  advertise<desert_sim::Undo>("redo", &Services::redo);
  advertise<desert_sim::QueryTerrain>("query_terrain", &Services::query_terrain);
  advertise<desert_sim::GetSubmap>("get_submap", &Services::get_submap);
  advertise_get_grid_map();  // "get_grid_map", &Services::get_grid_map; GetGridMap has no field `success`
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

Services::Services(const ros::NodeHandle& node, ros::CallbackQueue& step_queue, SimulationThread& simulation,
                   TopicPublisher& publisher, Frames& frames, const DataFolder& files, double answer_timeout)
    : node_(node),
      simulation_(simulation),
      publisher_(publisher),
      frames_(frames),
      files_(files),
      answer_timeout_(answer_timeout),
      terrain_diff_(node_.advertise<TerrainDiff>("terrain_diff", 100)) {
  advertise_all(step_queue);
}

// ---- Wind, weather, plants.

void Services::set_wind(const SetWindRequest& request, SetWindResponse&) {
  simulation_.apply(wind_command(request)).get();
  publisher_.status_changed();
}

void Services::set_wind_schedule(const SetWindScheduleRequest& request, SetWindScheduleResponse&) {
  simulation_.apply(wind_schedule_command(request)).get();
  publisher_.status_changed();
}

void Services::set_weather(const SetWeatherRequest& request, SetWeatherResponse&) {
  simulation_.apply(weather_command(request)).get();
  publisher_.status_changed();
}

void Services::edit_wind(const EditWindRequest& request, EditWindResponse&) {
  simulation_.apply(wind_edit_command(request, frames_)).get();
  publisher_.status_changed();
}

void Services::edit_plants(const EditPlantsRequest& request, EditPlantsResponse& response) {
  const ReachedState reached = simulation_.apply(plants_command(request, frames_)).get();
  response.plants = reached.result.plants;
  response.step = reached.moment.step;
  publisher_.status_changed();
}

// ---- Edits of the terrain, undo, and ~terrain_diff.

namespace {

template <class Message>
void set_rectangle(const CellRectangle& cells, Message& message) {
  message.x = static_cast<std::uint32_t>(cells.x0);
  message.y = static_cast<std::uint32_t>(cells.y0);
  message.width = static_cast<std::uint32_t>(cells.x1 - cells.x0);
  message.height = static_cast<std::uint32_t>(cells.y1 - cells.y0);
}

/// What a command that was asked for with its change has changed in one layer.
TerrainDiffPtr diff_message(const ReachedState& edit, const LayerChange& change, const std::string& frame) {
  const CellRectangle& touched = edit.result.changed_cells;
  TerrainDiffPtr message = boost::make_shared<TerrainDiff>();
  message->header = header_of(edit.moment, frame);
  message->step = edit.moment.step;
  message->layer = change.layer;
  message->cell_size = change.cell_size;
  message->origin.position.x = change.x;
  message->origin.position.y = change.y;
  message->origin.orientation.w = 1;
  message->change = change.values;
  set_rectangle(touched, *message);
  return message;
}

}  // namespace

ReachedState Services::apply_and_tell(const Command& command) {
  const bool diff = terrain_diff_.getNumSubscribers() > 0;
  ReachedState reached = simulation_.apply(command, false, diff).get();
  for (const LayerChange& change : reached.result.changes)
    terrain_diff_.publish(diff_message(reached, change, frames_.terrain_frame()));
  publisher_.status_changed();
  return reached;
}

void Services::edit_terrain(const EditTerrainRequest& request, EditTerrainResponse& response) {
  const ReachedState reached = apply_and_tell(edit_command(request, frames_));
  response.volume = reached.result.volume_m3;
  response.moved = reached.result.moved_m3;
  set_rectangle(reached.result.changed_cells, response);
  response.step = reached.moment.step;
}

namespace {

void answer(const ReachedState& reached, UndoResponse& response) {
  const CommandResult& result = reached.result;
  response.stroke = result.returned.name;
  for (std::size_t m = 0; m < result.returned.materials.size(); ++m) {
    const auto& volumes = result.returned.materials[m];
    if (!volumes) continue;
    ReturnedMaterial material;
    material.material = material_names[m];
    material.added = volumes->added_m3;
    material.removed = volumes->removed_m3;
    material.missing = volumes->missing_m3;
    response.materials.push_back(material);
  }
  response.plants = result.plants;
  response.missing_plants = result.returned.missing_plants;
  set_rectangle(result.changed_cells, response);
  response.step = reached.moment.step;
  response.undoable = static_cast<std::uint32_t>(result.undoable);
  response.redoable = static_cast<std::uint32_t>(result.redoable);
}

}  // namespace

void Services::undo(const UndoRequest& request, UndoResponse& response) {
  answer(apply_and_tell(command::Undo{request.stroke}), response);
}

void Services::redo(const UndoRequest& request, UndoResponse& response) {
  answer(apply_and_tell(command::Redo{request.stroke}), response);
}

// ---- Running.

void Services::step(const StepRequest& request, StepResponse& response) {
  const ReachedState reached = simulation_.step(request.steps).get();
  publisher_.publish_now();
  response.step = reached.moment.step;
  response.sim_time = reached.moment.time;
  response.state_hash = hash_text(reached.hash);
}

void Services::pause(const std_srvs::TriggerRequest&, std_srvs::TriggerResponse&) {
  simulation_.pause().get();
  publisher_.publish_now(answer_timeout_);
}

void Services::resume(const std_srvs::TriggerRequest&, std_srvs::TriggerResponse&) {
  simulation_.resume().get();
  publisher_.status_changed();
}

void Services::reset(const std_srvs::TriggerRequest&, std_srvs::TriggerResponse&) {
  simulation_.apply(command::Reset{}).get();
  ROS_INFO("The simulation was reset to the start of the scenario.");
  publisher_.publish_now(answer_timeout_);
}

// ---- Checkpoints, terrains and scenarios in files.

namespace {

constexpr const char* terrain_file = "terrain.yaml";  // in the folder of a saved terrain

}  // namespace

void Services::save_checkpoint(const SaveCheckpointRequest& request, SaveCheckpointResponse& response) {
  const WritableFile file = files_.for_writing(request.name);
  const ReachedState reached =
      file.write([&](const std::string& path) { return simulation_.save_checkpoint(path).get(); });
  response.path = file.path();
  response.step = reached.moment.step;
  response.state_hash = hash_text(reached.hash);
  ROS_INFO("The checkpoint of step %lu was saved to %s.", static_cast<unsigned long>(response.step),
           response.path.c_str());
}

void Services::load_checkpoint(const LoadCheckpointRequest& request, LoadCheckpointResponse& response) {
  const std::string path = files_.for_reading(request.name);
  const ReachedState reached = simulation_.apply(command::LoadCheckpoint{path, 0}, true).get();
  response.step = reached.moment.step;
  response.sim_time = reached.moment.time;
  response.state_hash = hash_text(reached.hash);
  ROS_INFO("The checkpoint of step %lu was loaded from %s.", static_cast<unsigned long>(response.step),
           path.c_str());
  terrain_replaced();
}

void Services::terrain_replaced() {
  const SimulationThread::Patience unlimited(0);  // the load has been done, and cannot be refused any more
  if (frames_.has_center()) {
    // One thread at a time, each with a copy of its own: the last one that moves the frame has seen the
    // newest terrain.
    const std::lock_guard<std::mutex> lock(move_center_mutex_);
    frames_.move_center(*simulation_.terrain({Layer::elevation}).get().snapshot);
  }
  publisher_.publish_now(answer_timeout_);
}

void Services::save_terrain(const SaveTerrainRequest& request, SaveTerrainResponse& response) {
  const TerrainFormat format = terrain_format(request.format);
  if (is_bag(request.name))
    throw ConfigError(
        "name: " + quoted(request.name) +
        " has the extension .bag, which load_terrain reads as a file (allowed: the name of a folder)");
  const WritableFile file = files_.for_writing(request.name + "/" + terrain_file);
  const TerrainToSave terrain = simulation_.terrain_to_save(file.path()).get();
  const LayerWriter writer =
      layer_writer(format, terrain, frames_.terrain_frame(), node_.resolveName("grid_map"));
  file.write([&](const std::string& path) {
    desert_sim::save_terrain(path, terrain.scenario, *terrain.state.snapshot, writer,
                             hash_text(terrain.hash));
  });
  response.path = file.path();
  response.step = terrain.state.moment.step;
  ROS_INFO("The terrain of step %lu was saved to %s.", static_cast<unsigned long>(response.step),
           response.path.c_str());
}

void Services::load_terrain(const LoadTerrainRequest& request, LoadTerrainResponse& response) {
  const std::string name = is_bag(request.name) ? request.name : request.name + "/" + terrain_file;
  response.state_hash = load({files_.for_reading(name), true, 0, request.fill_nodata != 0});
}

/// A name that is no file's either may be that of an installed scenario, mistyped.
std::string Services::scenario_below_data_folder(const std::string& name) const {
  try {
    return files_.for_reading(name);
  } catch (const ConfigError& e) {
    if (name.find('/') != std::string::npos) throw;
    const std::string known = joined(installed_scenarios());
    throw ConfigError(std::string(e.what()) + "; nor is it an installed scenario (known: " + known + ")" +
                      did_you_mean(name, known));
  }
}

void Services::load_scenario(const LoadScenarioRequest& request, LoadScenarioResponse& response) {
  command::LoadScenario command;
  command.path = installed_scenario_file(request.name);
  if (command.path.empty())
    command.path = scenario_below_data_folder(request.name);
  else
    command.folder = installed_scenario_folder();
  response.state_hash = load(command);
}

std::string Services::load(const command::LoadScenario& command) {
  const ReachedState reached = simulation_.apply(command, true).get();
  ROS_INFO("%s was loaded.", command.path.c_str());
  terrain_replaced();
  return hash_text(reached.hash);
}

}  // namespace desert_sim
