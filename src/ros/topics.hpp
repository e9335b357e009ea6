#pragma once
/// The topics, and the thread that publishes them. It asks the simulation thread for a copy of the layers
/// that the topics which are due need, and makes the messages of it, so that publishing never holds up a
/// step. A topic without subscribers asks for nothing. Topics are "latched" in effect: a new subscriber is
/// sent the present state, not an old one.

#include <desert_sim/SimulationStatus.h>
#include <ros/node_handle.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "desert_sim/ros/elevation_stream.hpp"
#include "desert_sim/ros/node_parameters.hpp"
#include "desert_sim/ros/simulation_thread.hpp"
#include "desert_sim/ros/wind_markers.hpp"

namespace desert_sim {

class Topics {
 public:
  /// `node` is private to the node; its callback queue must be served by another thread.
  Topics(ros::NodeHandle node, const PublisherParameters& parameters, const std::string& frame,
         SimulationThread& simulation);
  ~Topics();

  /// The state has changed, or the simulation has failed. Quick, and from any thread.
  void notify();
  /// Something that ~status says has changed, and not by a step: it is due.
  void status_changed();
  /// Returns once all that has changed until now has been published.
  void publish_now();
  /// Ends the thread; publish_now() no longer waits.
  void stop();
  /// What made publishing end, of which ~status has told then: a failure of the simulation or of publishing.
  /// Empty while all is well.
  std::string failure() const;

 private:
  using Clock = std::chrono::steady_clock;

  struct Topic {
    ros::Publisher publisher;
    Clock::duration period{0};  ///< 0: no rate
    std::vector<Layer> layers;
    std::function<bool(const TerrainState&)> publish;  ///< whether a message went out
    Clock::time_point due;
    std::uint64_t change = 0, terrain = 0;  ///< of the state that was published last
    bool wanted = false;                    ///< by a new subscriber; under mutex_
  };

  template <class Message>
  ros::Publisher advertise(const std::string& name, std::uint32_t queue, std::function<void()> on_subscriber);
  template <class Message>
  ros::Publisher advertise_terrain(const std::string& name, std::uint32_t queue, Topic& wanted);
  Topic& add(double rate, std::vector<Layer> layers);
  void add_elevation(const PublisherParameters& p);
  void add_others(const PublisherParameters& p);
  void want(Topic& topic);

  void thread();
  void loop();
  /// Sleeps until something is due or asked for. False if the thread is to end.
  bool wait(bool& all, bool& status, std::uint64_t& asked);
  bool something_is_due(Clock::time_point& next, bool& listen);
  std::vector<Topic*> topics_that_are_due(bool all);
  void publish_terrain(const std::vector<Topic*>& due);
  void publish_status();
  void publish_failure(const std::string& what);

  ros::NodeHandle node_;
  const std::string frame_;
  SimulationThread& simulation_;
  std::vector<std::unique_ptr<Topic>> topics_;
  std::unique_ptr<ElevationStream> elevation_;
  std::unique_ptr<WindMarkers> markers_;
  ros::Publisher status_;
  Clock::duration status_period_{0};
  Clock::time_point status_due_;
  SimulationStatus last_status_;
  std::uint64_t publications_ = 0;

  mutable std::mutex mutex_;
  std::condition_variable woken_, served_some_;
  std::atomic<bool> listens_to_changes_{false};
  bool status_wanted_ = false, stopping_ = false;
  std::uint64_t asked_ = 0, served_ = 0;  ///< calls of publish_now()
  std::string failure_;
  std::thread thread_;
  ros::Subscriber keyframe_requests_;  ///< the first to go: its callback uses all of this
};

}  // namespace desert_sim
