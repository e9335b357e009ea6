#pragma once
/// The topics, and the thread that publishes them. It asks the simulation thread for a copy of the layers
/// that the topics which are due need, and makes the messages of it, so that publishing never holds up a
/// step. A topic without subscribers asks for nothing. Topics are "latched" in effect: a new subscriber is
/// sent the present state, not an old one.

#include <desert_sim/SimulationStatus.h>
#include <ros/node_handle.h>

#include <atomic>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "src/ros/conversion/messages.hpp"
#include "src/ros/node/frames.hpp"
#include "src/ros/node/simulation_thread.hpp"
#include "src/ros/topics/costmap_stream.hpp"
#include "src/ros/topics/elevation_stream.hpp"
#include "src/ros/topics/plant_topics.hpp"
#include "src/ros/topics/publisher_parameters.hpp"
#include "src/ros/topics/topic.hpp"
#include "src/ros/topics/wind_markers.hpp"

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
  Topics(ros::NodeHandle node, const PublisherSetup& parameters, const Frames& frames,
         SimulationThread& simulation);
  ~Topics();

  /// The state has changed, or the simulation has failed. Quick, and from any thread.
  void notify();
  /// Something that ~status says has changed, and not by a step: it is due.
  void status_changed();
  /// Returns once all that has changed until now has been published. Subscribers who are told of changes by
  /// updates are sent those, and no keyframe.
  void publish_now();
  /// From now on; may be called from any thread.
  void set_parameters(const PublisherSetup& parameters);
  PublisherSetup parameters() const;
  /// Grows with each set_parameters().
  std::uint64_t parameter_changes() const { return parameter_changes_; }
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
  template <class Message>
  ros::Publisher advertise(const std::string& name, std::uint32_t queue, std::function<void()> on_subscriber);
  template <class Message>
  ros::Publisher advertise_terrain(const std::string& name, std::uint32_t queue, Topic& wanted);
  /// Keeps the names of the subscribers to `topic`.
  template <class Message>
  ros::Publisher advertise_named(const std::string& name, std::uint32_t queue, Topic& topic, Topic& wanted);
  Topic& add(const double& rate, std::function<std::vector<Layer>()> layers);
  Topic& add(const double& rate, const std::vector<Layer>& layers);
  void add_elevation();
  void add_wind();
  void add_points();
  void add_plants();
  void add_grid_map();
  void add_local_map();
  void add_costmap();
  void add_image();
  /// As a GridMap, the cells that `choose` says; if it refuses (ConfigError) nothing, and the reason is kept.
  bool publish_cut(const Topic& topic, const std::string& name, const std::vector<MapLayer>& layers,
                   int decimation, const std::function<MapWindow(const Snapshot&)>& choose);
  void want(Topic& topic);
  /// Keeps `problem` for problems(); none if it is empty.
  void set_problem(const std::string& topic, const std::string& problem);

  /// Under mutex_.
  void adopt(const PublisherSetup& parameters);
  void thread();
  void loop();
  /// Sleeps until something is due or asked for. False if the thread is to end.
  bool wait(bool& all, bool& status, std::uint64_t& asked);
  bool something_is_due(SteadyClock::time_point& next, bool& listen);
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
  PublisherSetup parameters_;  ///< changed by the publishing thread, under mutex_
  std::vector<std::unique_ptr<Topic>> topics_;
  std::unique_ptr<ElevationStream> elevation_;
  std::unique_ptr<WindMarkers> markers_;
  std::unique_ptr<PlantMarkers> plant_markers_;
  std::unique_ptr<CostmapStream> costmap_;
  ros::Publisher status_, diff_;
  ros::Publisher costmap_is_latched_;  ///< publishes nothing
  SteadyClock::time_point status_due_;
  SimulationStatus last_status_;
  std::uint64_t publications_ = 0;

  mutable std::mutex mutex_;  ///< of what is below, and of topics' `wanted`, `names` and `meter`
  std::condition_variable woken_, served_some_;
  std::atomic<bool> listens_to_changes_{false};
  std::optional<PublisherSetup> new_parameters_;
  std::atomic<std::uint64_t> parameter_changes_{0};
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

template <class Message>
ros::Publisher Topics::advertise_named(const std::string& name, std::uint32_t queue, Topic& topic,
                                       Topic& wanted) {
  return node_.advertise<Message>(
      name, queue,
      [this, &topic, &wanted](const ros::SingleSubscriberPublisher& subscriber) {
        const std::lock_guard<std::mutex> lock(mutex_);
        topic.names.joined(subscriber.getSubscriberName());
        wanted.wanted = true;
        woken_.notify_all();
      },
      [this, &topic](const ros::SingleSubscriberPublisher& subscriber) {
        const std::lock_guard<std::mutex> lock(mutex_);
        topic.names.left(subscriber.getSubscriberName());
      });
}

}  // namespace desert_sim
