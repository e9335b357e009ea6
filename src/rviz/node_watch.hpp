#pragma once
/// Watches the status of a node, and the rovers and planners beside it, on a thread of its own, and tells the
/// thread of Qt what is there.

#include <desert_sim/SimulationStatus.h>
#include <desert_sim/WindFeatureList.h>
#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>
#include <ros/callback_queue.h>

#include <QObject>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "src/rviz/fleet.hpp"

namespace desert_sim {

class NodeWatch : public QObject {
  Q_OBJECT

 public:
  enum class Presence {
    searching,  ///< nothing is known yet
    no_master,  ///< the ROS master does not answer
    no_node,    ///< nobody answers under the node's name
    alive,
  };

  explicit NodeWatch(QObject* parent = nullptr);
  ~NodeWatch() override;

  /// Watches the node of this name, such as /desert_sim, from now on. It begins with searching. An empty
  /// name: none.
  void watch(const std::string& node);
  Presence presence() const { return presence_; }
  /// Connects to `cmd_vel` of this rover, such as /rover, from now on; empty: of none.
  void choose_rover(const std::string& rover);
  /// Sends a command to the chosen rover, if it is connected; never waits.
  void drive(const geometry_msgs::Twist& command) { fleet_.drive(command); }

 Q_SIGNALS:
  void presence_changed();
  /// `status` is shared with nobody who changes it.
  void status_came(const desert_sim::SimulationStatusConstPtr& status);
  /// What live parameters the node has; once.
  void description_came(const dynamic_reconfigure::ConfigDescriptionConstPtr& description);
  /// The node's live parameters, at the beginning and after each change.
  void parameters_came(const dynamic_reconfigure::ConfigConstPtr& parameters);
  /// The local features of the node's wind, at the beginning and after each change.
  void wind_features_came(const desert_sim::WindFeatureListConstPtr& features);
  /// All rovers and planners in the node's namespace, whenever they or what they say have changed.
  void rovers_changed(const desert_sim::RoverNames& rovers);
  void planners_changed(const desert_sim::PlannerStatuses& planners);

 private:
  using Clock = std::chrono::steady_clock;

  void loop();
  /// To the status, the parameters and the wind's features of a node.
  void subscribe(const std::string& node);
  void unsubscribe();
  /// What is found out without a message.
  Presence look(const std::string& node) const;
  /// Calls `news` in the thread of Qt, unless another node is watched by then.
  void tell(unsigned generation, std::function<void()> news);
  void set_presence(Presence presence);

  Presence presence_ = Presence::searching;  ///< in the thread of Qt
  ros::CallbackQueue queue_;                 ///< of the thread
  ros::NodeHandle node_handle_;              ///< with the queue above
  ros::Subscriber status_subscriber_, parameter_subscriber_, description_subscriber_, feature_subscriber_;
  Clock::time_point heard_;       ///< when the last status came
  unsigned seen_generation_ = 0;  ///< the one that the thread works for
  Fleet fleet_;

  std::mutex mutex_;  ///< guards the next five
  std::condition_variable wake_up_;
  std::string wanted_, rover_;
  unsigned generation_ = 0;  ///< counts calls of watch()
  bool ending_ = false;
  std::thread thread_;  ///< the last member: it uses the others
};

}  // namespace desert_sim
