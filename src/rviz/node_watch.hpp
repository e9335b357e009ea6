#pragma once
/// Watches the status of a node on a thread of its own, and tells the thread of Qt what is there.

#include <desert_sim/SimulationStatus.h>
#include <dynamic_reconfigure/Config.h>
#include <ros/callback_queue.h>

#include <QObject>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

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

 Q_SIGNALS:
  void presence_changed();
  /// `status` is shared with nobody who changes it.
  void status_came(const desert_sim::SimulationStatusConstPtr& status);
  /// The node's live parameters, at the beginning and after each change.
  void parameters_came(const dynamic_reconfigure::ConfigConstPtr& parameters);

 private:
  void loop();
  /// What is found out without a message.
  Presence look(const std::string& node) const;
  /// Calls `news` in the thread of Qt, unless another node is watched by then.
  void tell(unsigned generation, std::function<void()> news);
  void set_presence(Presence presence);

  Presence presence_ = Presence::searching;  ///< in the thread of Qt

  std::mutex mutex_;  ///< guards the next four
  std::condition_variable wake_up_;
  std::string wanted_;
  unsigned generation_ = 0;  ///< counts calls of watch()
  bool ending_ = false;
  std::thread thread_;  ///< the last member: it uses the others
};

}  // namespace desert_sim
