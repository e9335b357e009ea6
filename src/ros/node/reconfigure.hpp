#pragma once
/// dynamic_reconfigure for the parameters that can change live, without a .cfg file: the parameter tables
/// are the description. ~parameter_descriptions, ~parameter_updates, ~set_parameters as its clients expect.

#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <mutex>

#include "src/ros/node/reconfigure_messages.hpp"
#include "src/ros/node/simulation_thread.hpp"
#include "src/ros/topics/topics.hpp"

namespace desert_sim {

/// A change of the scenario is a command: applied between steps, all of it or nothing, and journalled. A call
/// that is refused fails, and the log says why. What commands, a reset, a checkpoint or ~reload_parameters
/// change shows in ~parameter_updates.
class Reconfigure {
 public:
  Reconfigure(ros::NodeHandle node, SimulationThread& simulation, Topics& topics);

 private:
  using Request = dynamic_reconfigure::Reconfigure::Request;
  using Response = dynamic_reconfigure::Reconfigure::Response;
  bool set(Request& request, Response& response);
  void look();
  LiveParameters present() const;
  void publish(const dynamic_reconfigure::Config& values);

  SimulationThread& simulation_;
  Topics& topics_;
  std::mutex mutex_;
  dynamic_reconfigure::Config published_;  ///< under mutex_, as the next two
  dynamic_reconfigure::ConfigConstPtr to_publish_;
  bool publishing_ = false;
  std::uint64_t seen_ = 0;             ///< commands of the simulation, when it was last looked at
  std::uint64_t seen_publishers_ = 0;  ///< changes of the topics' parameters then
  double seen_rate_ = -1;              ///< step rate then [steps/s]
  ros::Publisher descriptions_, updates_;
  ros::ServiceServer service_;
  ros::WallTimer timer_;
};

}  // namespace desert_sim
