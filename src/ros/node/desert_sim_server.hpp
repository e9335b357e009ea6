#pragma once
/// The node as an object, for the program desert_sim_node and for the nodelet: parameters, simulation, topics
/// and services, on threads of its own.

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <atomic>
#include <memory>
#include <string>

#include "src/core/data_folder.hpp"
#include "src/core/monotonic_clock.hpp"
#include "src/ros/conversion/frames.hpp"
#include "src/ros/forecast/forecast_server.hpp"
#include "src/ros/node/diagnostics.hpp"
#include "src/ros/node/reconfigure.hpp"
#include "src/ros/node/reload_parameters.hpp"
#include "src/ros/services/cmd_wind.hpp"
#include "src/ros/services/services.hpp"
#include "src/ros/simulation/autosave.hpp"
#include "src/ros/simulation/clock.hpp"
#include "src/ros/simulation/simulation_thread.hpp"
#include "src/ros/topics/topic_publisher.hpp"

namespace desert_sim {

class DesertSimServer {
 public:
  /// Reads the parameters below `private_node`, builds the terrain and starts. Schedules go by the clock,
  /// which outlives the server. Throws ConfigError for input that is refused.
  explicit DesertSimServer(const ros::NodeHandle& private_node,
                           const MonotonicClock& clock = computer_clock());
  /// Ends after the present step. Calls of services that wait get success = false.
  ~DesertSimServer();

  /// What failed at run time, which ~status has said by then; empty while all is well.
  std::string failure() const { return publisher_->failure(); }

 private:
  // Callbacks have queues and threads of their own, because services wait for the simulation. ~step can take
  // long, and has a queue apart from the others.
  ros::CallbackQueue queue_, step_queue_;
  ros::NodeHandle node_;
  std::unique_ptr<DataFolder> files_;
  std::unique_ptr<Frames> frames_;
  std::unique_ptr<ClockPublisher> clock_;
  std::atomic<TopicPublisher*> publisher_to_notify_{nullptr};
  std::unique_ptr<SimulationThread> simulation_;
  std::unique_ptr<TopicPublisher> publisher_;
  std::unique_ptr<Services> services_;
  std::unique_ptr<Autosave> autosave_;
  std::unique_ptr<ForecastServer> forecast_;
  std::unique_ptr<Diagnostics> diagnostics_;
  std::unique_ptr<CmdWindSubscriber> cmd_wind_;
  std::unique_ptr<Reconfigure> reconfigure_;
  std::unique_ptr<ParameterReload> reload_;
  ros::AsyncSpinner spinner_, step_spinner_;
};

}  // namespace desert_sim
