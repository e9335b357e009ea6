#pragma once
/// A server of dynamic_reconfigure for the parameters that can change live, without a .cfg file: the
/// parameter tables are the description. It has ~parameter_descriptions, ~parameter_updates and
/// ~set_parameters, as clients expect.

#include <dynamic_reconfigure/ConfigDescription.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <mutex>

#include "src/ros/parameters/reconfigure_messages.hpp"
#include "src/ros/simulation/simulation_thread.hpp"
#include "src/ros/support/latched_publisher.hpp"
#include "src/ros/topics/topic_publisher.hpp"

namespace desert_sim {

/// A change of the scenario is a command: applied between steps, all of it or nothing, and journalled. A call
/// that is refused fails with the reason, which the log has too. What commands, a reset, a checkpoint or
/// ~reload_parameters change shows in ~parameter_updates.
class Reconfigure {
 public:
  /// `answer_timeout`: see SimulationThread::Patience.
  Reconfigure(ros::NodeHandle node, SimulationThread& simulation, TopicPublisher& publisher,
              double answer_timeout);

 private:
  using Request = dynamic_reconfigure::Reconfigure::Request;
  using Response = dynamic_reconfigure::Reconfigure::Response;
  void set(const Request& request, Response& response);
  void publish_if_changed();
  LiveParameters present() const;
  void publish(const dynamic_reconfigure::Config& values);

  SimulationThread& simulation_;
  TopicPublisher& publisher_;
  const double answer_timeout_;            ///< [s]
  std::mutex mutex_;                       ///< guards the next three
  dynamic_reconfigure::Config published_;  ///< what was published last
  dynamic_reconfigure::ConfigConstPtr to_publish_;
  bool publishing_ = false;
  // When it was last checked whether parameters have changed; of the timer's callback alone:
  std::uint64_t seen_commands_ = 0;    ///< of the simulation
  std::uint64_t seen_publishers_ = 0;  ///< changes of the parameters of topics
  double seen_rate_ = -1;              ///< step rate [steps/s]
  LatchedPublisher<dynamic_reconfigure::ConfigDescription> descriptions_;
  LatchedPublisher<dynamic_reconfigure::Config> updates_;
  ros::ServiceServer service_;
  ros::WallTimer timer_;
};

}  // namespace desert_sim
