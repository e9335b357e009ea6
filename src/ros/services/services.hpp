#pragma once
/// The services. Each turns a request into a command and waits for the simulation thread's answer.

#include <desert_sim/EditPlants.h>
#include <desert_sim/EditTerrain.h>
#include <desert_sim/EditWind.h>
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
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>

#include <chrono>
#include <mutex>
#include <string>
#include <vector>

#include "src/ros/node/data_folder.hpp"
#include "src/ros/node/frames.hpp"
#include "src/ros/node/simulation_thread.hpp"
#include "src/ros/services/submaps.hpp"
#include "src/ros/topics/topics.hpp"

namespace desert_sim {

class Services {
 public:
  /// `step_queue` serves ~step apart from the rest: it can take long, and a pause must come through.
  Services(ros::NodeHandle node, ros::CallbackQueue& step_queue, SimulationThread& simulation, Topics& topics,
           Frames& frames, const DataFolder& files);

 private:
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
  void query_terrain(const QueryTerrainRequest& request, QueryTerrainResponse& response);
  void get_submap(const GetSubmapRequest& request, GetSubmapResponse& response);
  void advertise_grid_map();
  void step(const StepRequest& request, StepResponse& response);
  void pause(const std_srvs::TriggerRequest& request, std_srvs::TriggerResponse& response);
  void resume(const std_srvs::TriggerRequest& request, std_srvs::TriggerResponse& response);
  void reset(const std_srvs::TriggerRequest& request, std_srvs::TriggerResponse& response);
  void save_checkpoint(const SaveCheckpointRequest& request, SaveCheckpointResponse& response);
  void load_checkpoint(const LoadCheckpointRequest& request, LoadCheckpointResponse& response);
  void save_terrain(const SaveTerrainRequest& request, SaveTerrainResponse& response);
  void load_terrain(const LoadTerrainRequest& request, LoadTerrainResponse& response);
  void load_scenario(const LoadScenarioRequest& request, LoadScenarioResponse& response);
  /// Returns the hash at the new start.
  std::string begin(const command::LoadScenario& command);
  /// Tells the world of another terrain.
  void terrain_replaced();

  /// A copy that is new enough for a query; made anew only if the last one is not.
  TerrainState recent_terrain();

  ros::NodeHandle node_;
  SimulationThread& simulation_;
  Topics& topics_;
  Frames& frames_;
  const DataFolder& files_;
  Submaps submaps_;
  std::mutex center_mutex_;  ///< of what terrain_replaced() does
  std::mutex recent_mutex_;
  TerrainState recent_;
  std::chrono::steady_clock::time_point recent_time_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace desert_sim
