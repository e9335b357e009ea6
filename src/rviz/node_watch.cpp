#include "src/rviz/node_watch.hpp"

#include <ros/master.h>
#include <ros/names.h>
#include <ros/node_handle.h>
#include <ros/service.h>

#include <QMetaObject>
#include <optional>

namespace desert_sim {

namespace {

constexpr std::chrono::milliseconds longest_silence(
    2500);  // the node sends its status once a second by default
constexpr std::chrono::milliseconds between_looks(1000), between_fleet_looks(2000), pause(50);

ros::NodeHandle with_queue(ros::CallbackQueue& queue) {
  ros::NodeHandle node;
  node.setCallbackQueue(&queue);
  return node;
}

}  // namespace

NodeWatch::NodeWatch(QObject* parent)
    : QObject(parent),
      node_handle_(with_queue(queue_)),
      fleet_(
          node_handle_,
          [this](const RoverNames& rovers) {
            tell(seen_generation_, [this, rovers] { Q_EMIT rovers_changed(rovers); });
          },
          [this](const PlannerStatuses& planners) {
            tell(seen_generation_, [this, planners] { Q_EMIT planners_changed(planners); });
          }),
      thread_([this] { loop(); }) {}

NodeWatch::~NodeWatch() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
    ++generation_;
  }
  wake_up_.notify_all();
  thread_.join();
}

void NodeWatch::watch(const std::string& node) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    wanted_ = node;
    ++generation_;
  }
  presence_ = Presence::searching;
  wake_up_.notify_all();
  Q_EMIT presence_changed();
}

NodeWatch::Presence NodeWatch::look(const std::string& node) const {
  if (ros::service::exists(node + "/pause", false)) return Presence::alive;  // it connects to the node
  return ros::master::check() ? Presence::no_node : Presence::no_master;
}

void NodeWatch::tell(unsigned generation, std::function<void()> news) {
  QMetaObject::invokeMethod(
      this,
      [this, generation, news = std::move(news)] {
        {
          const std::lock_guard<std::mutex> lock(mutex_);
          if (generation != generation_) return;
        }
        news();
      },
      Qt::QueuedConnection);
}

void NodeWatch::set_presence(Presence presence) {
  if (presence == presence_) return;
  presence_ = presence;
  Q_EMIT presence_changed();
}

void NodeWatch::choose_rover(const std::string& rover) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    rover_ = rover;
  }
  wake_up_.notify_all();
}

void NodeWatch::subscribe(const std::string& node) {
  const unsigned generation = seen_generation_;
  const boost::function<void(const SimulationStatusConstPtr&)> hear =
      [this, generation](const SimulationStatusConstPtr& status) {
        heard_ = Clock::now();
        tell(generation, [this, status] {
          set_presence(Presence::alive);
          Q_EMIT status_came(status);
        });
      };
  const boost::function<void(const dynamic_reconfigure::ConfigConstPtr&)> take =
      [this, generation](const dynamic_reconfigure::ConfigConstPtr& parameters) {
        tell(generation, [this, parameters] { Q_EMIT parameters_came(parameters); });
      };
  status_subscriber_ = node_handle_.subscribe<SimulationStatus>(node + "/status", 1, hear);
  const boost::function<void(const dynamic_reconfigure::ConfigDescriptionConstPtr&)> learn =
      [this, generation](const dynamic_reconfigure::ConfigDescriptionConstPtr& description) {
        tell(generation, [this, description] { Q_EMIT description_came(description); });
      };
  parameter_subscriber_ =
      node_handle_.subscribe<dynamic_reconfigure::Config>(node + "/parameter_updates", 1, take);
  description_subscriber_ = node_handle_.subscribe<dynamic_reconfigure::ConfigDescription>(
      node + "/parameter_descriptions", 1, learn);
  const boost::function<void(const WindFeatureListConstPtr&)> list =
      [this, generation](const WindFeatureListConstPtr& features) {
        tell(generation, [this, features] { Q_EMIT wind_features_came(features); });
      };
  feature_subscriber_ = node_handle_.subscribe<WindFeatureList>(node + "/wind_features", 1, list);
}

void NodeWatch::unsubscribe() {
  status_subscriber_ = parameter_subscriber_ = description_subscriber_ = feature_subscriber_ =
      ros::Subscriber();
}

void NodeWatch::loop() {
  std::string node, rover;
  Clock::time_point looked, looked_for_fleet;
  while (true) {
    bool other_node = false;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      wake_up_.wait_for(lock, pause,
                        [&] { return ending_ || generation_ != seen_generation_ || rover_ != rover; });
      if (ending_) break;
      other_node = generation_ != seen_generation_;
      seen_generation_ = generation_;
      node = wanted_;
      rover = rover_;
    }
    if (other_node) {
      unsubscribe();
      heard_ = looked = looked_for_fleet = Clock::time_point();
      fleet_.forget();
    }
    fleet_.choose(rover);
    queue_.callAvailable();
    const auto now = Clock::now();
    if (!node.empty() && now - looked_for_fleet >= between_fleet_looks) {
      looked_for_fleet = now;
      fleet_.look(node);
    }
    const bool silent = now - heard_ >= longest_silence || status_subscriber_.getNumPublishers() == 0;
    if (node.empty() || !silent || now - looked < between_looks) continue;
    looked = now;
    const Presence presence = look(node);
    // A new subscription also finds a node that was started anew under a new master, and is sent the status
    // at once.
    unsubscribe();
    if (presence == Presence::alive) subscribe(node);
    tell(seen_generation_, [this, presence] { set_presence(presence); });
  }
}

}  // namespace desert_sim
