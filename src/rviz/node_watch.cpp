#include "src/rviz/node_watch.hpp"

#include <ros/master.h>
#include <ros/names.h>
#include <ros/node_handle.h>
#include <ros/service.h>

#include <QMetaObject>
#include <chrono>
#include <optional>

namespace desert_sim {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds longest_silence(
    2500);  // the node sends its status once a second by default
constexpr std::chrono::milliseconds between_looks(1000), pause(50);

}  // namespace

NodeWatch::NodeWatch(QObject* parent) : QObject(parent), thread_([this] { loop(); }) {}

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

void NodeWatch::loop() {
  ros::CallbackQueue queue;
  ros::NodeHandle node_handle;
  node_handle.setCallbackQueue(&queue);
  ros::Subscriber subscriber, parameter_subscriber;
  std::string node;
  unsigned generation = 0;
  Clock::time_point heard, looked;
  while (true) {
    {
      std::unique_lock<std::mutex> lock(mutex_);
      wake_up_.wait_for(lock, pause, [&] { return ending_ || generation_ != generation; });
      if (ending_) break;
      if (generation_ != generation) {
        generation = generation_;
        node = wanted_;
        subscriber = parameter_subscriber = ros::Subscriber();
        heard = looked = Clock::time_point();
      }
    }
    queue.callAvailable();
    const auto now = Clock::now();
    const bool silent = now - heard >= longest_silence || subscriber.getNumPublishers() == 0;
    if (node.empty() || !silent || now - looked < between_looks) continue;
    looked = now;
    const Presence presence = look(node);
    // A new subscription also finds a node that was started anew under a new master, and is sent the status
    // at once.
    subscriber = parameter_subscriber = ros::Subscriber();
    if (presence == Presence::alive) {
      subscriber = node_handle.subscribe<SimulationStatus>(
          node + "/status", 1, [this, &heard, generation](const SimulationStatusConstPtr& status) {
            heard = Clock::now();
            tell(generation, [this, status] {
              set_presence(Presence::alive);
              Q_EMIT status_came(status);
            });
          });
      parameter_subscriber = node_handle.subscribe<dynamic_reconfigure::Config>(
          node + "/parameter_updates", 1,
          [this, generation](const dynamic_reconfigure::ConfigConstPtr& parameters) {
            tell(generation, [this, parameters] { Q_EMIT parameters_came(parameters); });
          });
    }
    tell(generation, [this, presence] { set_presence(presence); });
  }
}

}  // namespace desert_sim
