#pragma once
/// The services of the node. Each turns a request into a command, or a question, and waits for the answer of
/// the simulation thread. The table of services is advertise_all() in services.cpp.

#include <desert_sim/EditPlants.h>
#include <desert_sim/EditTerrain.h>
#include <desert_sim/EditWind.h>
#include <desert_sim/GetSubmap.h>
#include <desert_sim/LoadCheckpoint.h>
#include <desert_sim/LoadScenario.h>
#include <desert_sim/LoadTerrain.h>
#include <desert_sim/QueryTerrain.h>
#include <desert_sim/SaveCheckpoint.h>
#include <desert_sim/SaveTerrain.h>
#include <desert_sim/SetWeather.h>
#include <desert_sim/SetWind.h>
#include <desert_sim/SetWindSchedule.h>
#include <desert_sim/Step.h>
#include <desert_sim/TerrainDiff.h>
#include <desert_sim/Undo.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>

#include <chrono>
#include <mutex>
#include <string>
#include <vector>

#include "src/core/data_folder.hpp"
#include "src/grid_map/grid_map_msg.hpp"
#include "src/ros/conversion/frames.hpp"
#include "src/ros/conversion/map_window.hpp"
#include "src/ros/simulation/simulation_thread.hpp"
#include "src/ros/topics/topic_publisher.hpp"

namespace desert_sim {

class Services {
 public:
  /// `step_queue` serves ~step apart from the other services: it can take long, and ~pause must not wait for
  /// it. `answer_timeout`: see SimulationThread::Patience; ~step waits for its steps.
  Services(const ros::NodeHandle& node, ros::CallbackQueue& step_queue, SimulationThread& simulation,
           TopicPublisher& publisher, Frames& frames, const DataFolder& files, double answer_timeout);

 private:
  void advertise_all(ros::CallbackQueue& step_queue);
  /// Calls `serve` for each request. What it refuses (ConfigError), or any other failure, becomes the answer
  /// success = false with the reason.
  template <class Service>
  void advertise(const std::string& name,
                 void (Services::*serve)(const typename Service::Request&, typename Service::Response&),
                 ros::CallbackQueue* queue = nullptr);

  void set_wind(const SetWindRequest& request, SetWindResponse& response);
  void set_wind_schedule(const SetWindScheduleRequest& request, SetWindScheduleResponse& response);
  void set_weather(const SetWeatherRequest& request, SetWeatherResponse& response);
  void edit_wind(const EditWindRequest& request, EditWindResponse& response);
  void edit_plants(const EditPlantsRequest& request, EditPlantsResponse& response);
  void edit_terrain(const EditTerrainRequest& request, EditTerrainResponse& response);
  void undo(const UndoRequest& request, UndoResponse& response);
  void redo(const UndoRequest& request, UndoResponse& response);
  /// Applies a command that changes cells, and tells the subscribers of ~terrain_diff.
  ReachedState apply_and_tell(const Command& command);
  void query_terrain(const QueryTerrainRequest& request, QueryTerrainResponse& response);
  void get_submap(const GetSubmapRequest& request, GetSubmapResponse& response);
  GridMap get_grid_map(const GetGridMapRequest& request) const;
  void advertise_get_grid_map();
  void step(const StepRequest& request, StepResponse& response);
  void pause(const std_srvs::TriggerRequest& request, std_srvs::TriggerResponse& response);
  void resume(const std_srvs::TriggerRequest& request, std_srvs::TriggerResponse& response);
  void reset(const std_srvs::TriggerRequest& request, std_srvs::TriggerResponse& response);
  void save_checkpoint(const SaveCheckpointRequest& request, SaveCheckpointResponse& response);
  void load_checkpoint(const LoadCheckpointRequest& request, LoadCheckpointResponse& response);
  void save_terrain(const SaveTerrainRequest& request, SaveTerrainResponse& response);
  void load_terrain(const LoadTerrainRequest& request, LoadTerrainResponse& response);
  void load_scenario(const LoadScenarioRequest& request, LoadScenarioResponse& response);
  /// Starts from what the command loads. Returns the hash of the new state.
  std::string scenario_below_data_folder(const std::string& name) const;
  std::string load(const command::LoadScenario& command);
  /// Moves the frame in the middle of the terrain, and publishes all topics.
  void terrain_replaced();

  /// A copy of the terrain that is new enough for a query: the last one, if it still is.
  TerrainState recent_terrain();
  /// The layers in a rectangle around `center`, in the frame of `header` [m]. Throws ConfigError that names
  /// the field, its value and what is allowed.
  MapCut cut_region(const std::vector<MapLayer>& layers, const std_msgs::Header& header,
                    const geometry_msgs::Point& center, double length_x, double length_y) const;

  ros::NodeHandle node_;
  SimulationThread& simulation_;
  TopicPublisher& publisher_;
  Frames& frames_;
  const DataFolder& files_;
  const double answer_timeout_;   ///< [s]
  ros::Publisher terrain_diff_;   ///< ~terrain_diff: what each edit, undo and redo changed
  std::mutex move_center_mutex_;  ///< held while terrain_replaced() moves the frame
  std::mutex recent_mutex_;       ///< guards the next two
  TerrainState recent_;
  MonotonicClock::TimePoint recent_time_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace desert_sim
