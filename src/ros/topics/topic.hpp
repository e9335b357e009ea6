#pragma once
/// One topic that shows the terrain: what it needs, and when it is due.

#include <image_transport/publisher.h>
#include <ros/publisher.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "src/ros/node/pacer.hpp"
#include "src/ros/node/simulation_thread.hpp"

namespace desert_sim {

using SteadyClock = std::chrono::steady_clock;

/// 1 / rate; 0 for a rate of 0.
SteadyClock::duration period_of(double rate);
/// Moves `due` on by a period, or to a period from now if that has passed already.
void next_time(SteadyClock::time_point& due, SteadyClock::duration period);

/// Of the nodes that listen to a topic. A node that connects anew may be there twice for a while.
class SubscriberNames {
 public:
  void joined(const std::string& name) { ++count_[name]; }
  void left(const std::string& name);
  /// Whether all of these are among `others`.
  bool are_among(const SubscriberNames& others) const;

 private:
  std::map<std::string, int> count_;
};

struct Topic {
  ros::Publisher publisher;
  image_transport::Publisher image;  ///< in the publisher's place, where it is set
  const double* rate = nullptr;      ///< [Hz]; 0: none
  std::function<std::vector<Layer>()> layers;
  std::function<void(StateQuery&)> besides;          ///< if set: says what it wants besides layers
  std::function<bool(const TerrainState&)> publish;  ///< whether a message went out
  bool follows = false;           ///< is published at its rate even while the terrain stays as it is
  std::function<bool()> ready;    ///< if set: whether there is something to publish
  std::function<bool()> covered;  ///< if set: whether another topic tells all subscribers of changes
  SteadyClock::time_point due;
  std::uint64_t change = 0, terrain = 0;  ///< of the state that was published last
  bool wanted = false;                    ///< by a new subscriber
  SubscriberNames names;                  ///< only of topics that cover one another
  RateMeter meter;

  std::uint32_t subscribers() const {
    return image ? image.getNumSubscribers() : publisher.getNumSubscribers();
  }
  bool has_subscribers() const { return subscribers() > 0; }
  std::string name() const { return image ? image.getTopic() : publisher.getTopic(); }

  bool changed(const SimulationThread& now) const { return change != now.changes(); }
  /// Whatever its rate: a new subscriber, or another terrain.
  bool due_at_once(const SimulationThread& now) const { return wanted || terrain != now.terrains(); }
  bool due_by_rate(const SimulationThread& now) const {
    return *rate > 0 && SteadyClock::now() >= due && (follows || changed(now));
  }
  /// Shows this state now: the next one is due a period later.
  void shown(std::uint64_t that_change, std::uint64_t that_terrain);
  /// The rate has changed: not later than a period from now.
  void rate_changed();
};

}  // namespace desert_sim
