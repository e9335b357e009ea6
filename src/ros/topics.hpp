#pragma once
/// The topics, and the thread that publishes them. It asks the simulation thread for a copy of the layers
/// that the topics which are due need, and makes the messages of it, so that publishing never holds up a
/// step. A topic without subscribers asks for nothing. Topics are "latched" in effect: a new subscriber is
/// sent the present state, not an old one.

#include <desert_sim/SimulationStatus.h>
#include <image_transport/publisher.h>
#include <ros/node_handle.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "desert_sim/ros/costmap_stream.hpp"
#include "desert_sim/ros/elevation_stream.hpp"
#include "desert_sim/ros/messages.hpp"
#include "desert_sim/ros/frames.hpp"
#include "desert_sim/ros/node_parameters.hpp"
#include "desert_sim/ros/simulation_thread.hpp"
#include "desert_sim/ros/wind_markers.hpp"

namespace desert_sim {

/// How often a topic is published while there is something new [Hz].
struct TopicRate {
  std::string name;
  double wanted = 0, achieved = 0;
  unsigned subscribers = 0;
};

class Topics {
 public:
  /// `node` is private to the node; its callback queue must be served by another thread.
  Topics(ros::NodeHandle node, const PublisherParameters& parameters, const MapSetup& maps,
         const Frames& frames, SimulationThread& simulation);
  ~Topics();

  /// The state has changed, or the simulation has failed. Quick, and from any thread.
  void notify();
  /// Something that ~status says has changed, and not by a step: it is due.
  void status_changed();
  /// Returns once all that has changed until now has been published.
  void publish_now();
  /// Whether somebody wants to know what edits change.
  bool diff_wanted() const { return diff_.getNumSubscribers() > 0; }
  /// Publishes what an edit, asked for with its change, has changed. From any thread.
  void publish_diff(const Reached& edit) { diff_.publish(diff_message(edit, frame_)); }
  /// Ends the thread; publish_now() no longer waits.
  void stop();
  std::vector<TopicRate> rates() const;
  /// What made publishing end, of which ~status has told then: a failure of the simulation or of publishing.
  /// Empty while all is well.
  std::string failure() const;
  /// By the name of a topic, why nothing could be published on it when it was last due for somebody: for
  /// local_map that there is no transform.
  std::map<std::string, std::string> problems() const;

 private:
  using Clock = std::chrono::steady_clock;

  struct Topic {
    ros::Publisher publisher;
    image_transport::Publisher image;  ///< in the publisher's place, where it is set
    Clock::duration period{0};         ///< 0: no rate
    std::vector<Layer> layers;
    std::function<bool(const TerrainState&)> publish;  ///< whether a message went out
    bool follows = false;           ///< is published at its rate even while the terrain stays as it is
    std::function<bool()> ready;    ///< if set: whether there is something to publish
    std::function<bool()> covered;  ///< if set: whether another topic tells of changes
    Clock::time_point due;
    std::uint64_t change = 0, terrain = 0;  ///< of the state that was published last
    bool wanted = false;                    ///< by a new subscriber; under mutex_
    RateMeter meter;                        ///< under mutex_

    std::uint32_t subscribers() const {
      return image ? image.getNumSubscribers() : publisher.getNumSubscribers();
    }
    std::string name() const { return image ? image.getTopic() : publisher.getTopic(); }
    bool has_subscribers() const { return subscribers() > 0; }
  };

  template <class Message>
  ros::Publisher advertise(const std::string& name, std::uint32_t queue, std::function<void()> on_subscriber);
  template <class Message>
  ros::Publisher advertise_terrain(const std::string& name, std::uint32_t queue, Topic& wanted);
  Topic& add(double rate, std::vector<Layer> layers);
  void add_elevation(const PublisherParameters& p);
  void add_others(const PublisherParameters& p);
  void add_grid_map(const MapSetup& maps);
  void add_local_map(const MapSetup& maps);
  /// As a GridMap, the cells that `choose` says; if it refuses (ConfigError) nothing, and the reason is kept.
  bool publish_cut(const Topic& topic, const std::string& name, const std::vector<MapLayer>& layers,
                   int decimation, const std::function<MapWindow(const Snapshot&)>& choose);
  void add_costmap(const MapParameters& p);
  void add_image(const MapParameters& p);
  void want(Topic& topic);
  /// Keeps `problem` for problems(); none if it is empty.
  void set_problem(const std::string& topic, const std::string& problem);

  void thread();
  void loop();
  /// Sleeps until something is due or asked for. False if the thread is to end.
  bool wait(bool& all, bool& status, std::uint64_t& asked);
  bool something_is_due(Clock::time_point& next, bool& listen);
  std::vector<Topic*> topics_that_are_due(bool all);
  std::vector<Topic*> ready_ones(const std::vector<Topic*>& due);
  void publish_terrain(const std::vector<Topic*>& due);
  void publish_status();
  void publish_failure(const std::string& what);
  void keep_telling(const std::string& failure);

  ros::NodeHandle node_;
  const Frames& frames_;
  const std::string frame_;
  SimulationThread& simulation_;
  std::vector<std::unique_ptr<Topic>> topics_;
  std::unique_ptr<ElevationStream> elevation_;
  std::unique_ptr<WindMarkers> markers_;
  std::unique_ptr<CostmapStream> costmap_;
  ros::Publisher status_, diff_;
  ros::Publisher costmap_is_latched_;  ///< publishes nothing
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
  std::map<std::string, std::string> problems_;
  std::thread thread_;
  ros::Subscriber keyframe_requests_;  ///< the first to go: its callback uses all of this
};

template <class Message>
ros::Publisher Topics::advertise(const std::string& name, std::uint32_t queue,
                                 std::function<void()> on_subscriber) {
  return node_.advertise<Message>(
      name, queue, [on_subscriber](const ros::SingleSubscriberPublisher&) { on_subscriber(); });
}

/// A new subscriber makes `wanted` due.
template <class Message>
ros::Publisher Topics::advertise_terrain(const std::string& name, std::uint32_t queue, Topic& wanted) {
  return advertise<Message>(name, queue, [this, &wanted] { want(wanted); });
}

}  // namespace desert_sim
