#pragma once
/// The base class of the topics that show the terrain. A topic says what it needs of the state, how often it
/// is published, and how a state becomes its message; TopicPublisher decides when that happens. Each topic is
/// a class in a file of its own (wind_topic.cpp has ~wind), and topic_list.hpp lists them all.

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "src/ros/conversion/frames.hpp"
#include "src/ros/simulation/pacer.hpp"
#include "src/ros/simulation/simulation_thread.hpp"
#include "src/ros/topics/due_time.hpp"
#include "src/ros/topics/publisher_parameters.hpp"

namespace desert_sim {

using SteadyClock = DueTime::Clock;

/// 1 / rate; 0 for a rate of 0.
SteadyClock::duration period_of(double rate);

/// The names of the nodes that subscribe to a topic. A node that reconnects may be counted twice for a while.
class SubscriberNames {
 public:
  void add(const std::string& name) { ++count_[name]; }
  void remove(const std::string& name);
  /// Whether all of these are among `others`.
  bool is_subset_of(const SubscriberNames& others) const;

 private:
  std::map<std::string, int> count_;
};

/// The target and the measured rate of a topic [Hz].
struct TopicRate {
  std::string name;
  double wanted = 0, achieved = 0;
  unsigned subscribers = 0;
};

/// What the publisher shares with its topics. It outlives them.
struct TopicContext {
  ros::NodeHandle node;          ///< private to the node; another thread serves its callback queue
  SimulationThread& simulation;  ///< whose clock is that of the schedules
  const Frames& frames;
  /// The present parameters. Only the publishing thread changes them, and only under `mutex`: that thread
  /// reads them without it, any other thread with it.
  const PublisherSetup& parameters;
  /// Guards, in every topic, the request, the subscriber names, the rate meter and the problem.
  std::mutex& mutex;
  std::condition_variable& wake_up;  ///< wakes the publishing thread
};

/// A topic that shows the terrain. A topic without subscribers asks the simulation for nothing. Topics behave
/// like latched ones: a new subscriber is sent the present state, not an old one.
class Topic {
 public:
  virtual ~Topic() = default;
  Topic(const Topic&) = delete;
  Topic& operator=(const Topic&) = delete;

  // ---- What a topic defines. All but rate() and subscribers() are called by the publishing thread only.

  /// How often it is published while there is something new [Hz]. A rate of 0 leaves what is sent to new
  /// subscribers, before ~step answers, and after a reset or a load.
  virtual double rate() const = 0;
  virtual std::uint32_t subscribers() const = 0;
  /// How often it is published at present, if that is not its rate.
  virtual double pace() const { return rate(); }
  /// The layers that publish() reads from the snapshot of the state.
  virtual std::vector<Layer> layers() const { return {}; }
  /// Adds to `query` what publish() reads besides layers.
  virtual void add_to(StateQuery& /*query*/) {}
  /// Whether it can be published now. If not, it has set its problem, and waits for its next due time.
  virtual bool ready() { return true; }
  /// Whether it is published at its rate only after the state has changed.
  virtual bool only_after_change() const { return true; }
  /// Whether it may be published up to half a period early, right after a step; see DueTime.
  virtual bool may_be_early() const { return true; }
  /// Whether its rate also serves nodes that learn all changes from its updates (see set_updates()).
  virtual bool repeats_for_updated_nodes() const { return true; }
  /// Whether a message shows all there is, and not only what has changed: then it is published at
  /// `refresh_rate`, too, whether the state has changed or not.
  virtual bool is_refreshed() const { return true; }
  /// Gives back what the simulation keeps for subscribers. Called, perhaps often, while there are none.
  virtual void release() {}
  /// Publishes the state. False if there was no message to send.
  virtual bool publish(const TerrainState& state) = 0;
  /// Publishes the state, and leaves nothing of it for later: before ~step answers.
  virtual bool publish_all(const TerrainState& state) { return publish(state); }

  // ---- What the publisher asks of all topics.

  /// The name as ROS resolves it, such as /desert_sim/wind.
  const std::string& name() const { return name_; }
  /// The name without the node's namespace, such as wind.
  const std::string& short_name() const { return short_name_; }
  bool has_subscribers() const { return subscribers() > 0; }
  /// `updates` publishes every change of what this topic shows as a whole: nodes that subscribe to both need
  /// no message here because of a change.
  void set_updates(const Topic& updates) { updates_ = &updates; }
  /// Makes the topic due now, whatever its rate. From any thread.
  void request();
  /// Counts a message for the measured rate. Takes the mutex.
  void count_message();

  // The caller holds the mutex of the context:
  void drop_request() { requested_ = false; }
  /// Whether the state has changed since it was published here, and no updates tell all subscribers so.
  bool has_unpublished_change() const { return changed() && !is_covered(); }
  /// Whether it is published at its rate.
  bool follows_rate() const { return rate() > 0 && (repeats_for_updated_nodes() || !is_covered()); }
  /// Whether it must be published now: for a new subscriber, for another terrain, or at its rate.
  bool is_due() const { return due_immediately() || due_by_rate() || due_by_refresh(); }
  TopicRate measured_rate() const;
  /// Why nothing could be published when the topic was last due; empty if something could.
  const std::string& problem() const { return problem_; }

  // For the publishing thread alone:
  /// When to look again whether it is due by its rate; a time that has passed: after the next change.
  SteadyClock::time_point wake_time() const { return now() < early_time() ? early_time() : due_.time(); }
  /// Whether a change that comes now makes it due.
  bool listens() const { return now() >= early_time(); }
  /// Notes which state subscribers have been shown (counters of Moment), and since when that was under way;
  /// the next one is due a period later.
  void mark_published(std::uint64_t change, std::uint64_t terrain, SteadyClock::time_point since);
  /// The rate may have changed: the topic is due a period from now at the latest.
  void rate_changed();

 protected:
  Topic(const TopicContext& context, const std::string& name);
  const TopicContext& context() const { return context_; }
  const PublisherSetup& parameters() const { return context_.parameters; }
  const std::string& frame() const { return context_.frames.terrain_frame(); }
  ViewFrame view_frame() const { return context_.frames.view_frame(); }

  const Topic* updates() const { return updates_; }
  SteadyClock::time_point now() const { return context_.simulation.clock().now(); }

  // For callbacks of the publisher:
  /// Makes `due` due: this topic, or the one that a new subscriber needs first.
  void subscriber_joined(const std::string& subscriber, Topic& due);
  void subscriber_left(const std::string& subscriber);

  /// Keeps `problem`, and warns of it; an empty one means that all is well.
  void set_problem(const std::string& problem);
  /// Calls publish(). If it refuses (ConfigError), its reason becomes the problem, and the result is false.
  bool publish_or_set_problem(const std::function<void()>& publish);

 private:
  bool changed() const { return published_change_ != context_.simulation.changes(); }
  bool due_immediately() const { return requested_ || published_terrain_ != context_.simulation.terrains(); }
  bool due_by_rate() const {
    if (!follows_rate()) return false;
    const SteadyClock::time_point time = now();
    if (!only_after_change()) return time >= due_.time();
    return changed() && (may_be_early() ? due_.reached(time, context_.simulation.change_time(), period())
                                        : time >= due_.time());
  }
  bool due_by_refresh() const {
    const double rate = parameters().topics.refresh_rate;
    return rate > 0 && is_refreshed() && now() >= shown_ + period_of(rate);
  }
  SteadyClock::duration period() const { return period_of(pace()); }
  SteadyClock::time_point early_time() const {
    return only_after_change() && may_be_early() ? due_.earliest(period()) : due_.time();
  }
  bool is_covered() const { return updates_ && names_.is_subset_of(updates_->names_); }

  const TopicContext& context_;
  const std::string short_name_, name_;
  const Topic* updates_ = nullptr;

  // Used by the publishing thread alone:
  DueTime due_;
  SteadyClock::time_point shown_{};  ///< when it was published last
  std::uint64_t published_change_ = 0,
                published_terrain_ = 0;  ///< counters of the Moment that was shown last

  // Guarded by the mutex of the context:
  bool requested_ = false;  ///< by a new subscriber, say
  SubscriberNames names_;
  RateMeter meter_;
  std::string problem_;
};

/// A topic of one type of message, with the publisher that roscpp makes for it.
template <class Message>
class MessageTopic : public Topic {
 public:
  std::uint32_t subscribers() const override { return publisher_.getNumSubscribers(); }

 protected:
  /// `queue`: how many messages may wait for a slow subscriber. A new subscriber makes this topic due.
  MessageTopic(const TopicContext& context, const std::string& name, std::uint32_t queue = 1)
      : MessageTopic(context, name, queue, *this) {}
  /// A new subscriber makes `due` due instead.
  MessageTopic(const TopicContext& context, const std::string& name, std::uint32_t queue, Topic& due)
      : Topic(context, name) {
    ros::NodeHandle node = context.node;
    publisher_ = node.advertise<Message>(
        name, queue,
        [this, &due](const ros::SingleSubscriberPublisher& subscriber) {
          subscriber_joined(subscriber.getSubscriberName(), due);
        },
        [this](const ros::SingleSubscriberPublisher& subscriber) {
          subscriber_left(subscriber.getSubscriberName());
        });
  }

  ros::Publisher publisher_;
};

}  // namespace desert_sim
