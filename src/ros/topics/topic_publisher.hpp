#pragma once
/// The thread that publishes the topics of topic_list.hpp, and ~status. It asks the simulation thread for a
/// copy of what the topics need that are due, and makes their messages of it, so that publishing never holds
/// up a step.

#include <ros/node_handle.h>

#include <atomic>
#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "src/ros/conversion/frames.hpp"
#include "src/ros/simulation/simulation_thread.hpp"
#include "src/ros/topics/publisher_parameters.hpp"
#include "src/ros/topics/status_topic.hpp"
#include "src/ros/topics/topic_list.hpp"

namespace desert_sim {

class TopicPublisher {
 public:
  /// `node` is private to the node; another thread must serve its callback queue.
  TopicPublisher(const ros::NodeHandle& node, const PublisherSetup& parameters, const Frames& frames,
                 SimulationThread& simulation);
  ~TopicPublisher();

  // From any thread:

  /// Says that the state has changed, or that the simulation has failed. Returns quickly.
  void notify();
  /// Says that something that ~status shows has changed, and not by a step: ~status is due.
  void status_changed() { status_.request(); }
  /// Returns when all changes so far have been published, or after `patience` seconds if that is above 0:
  /// they are published then as soon as that is possible. Subscribers who learn changes from updates are sent
  /// those, and no keyframe.
  void publish_now(double patience = 0);
  /// The parameters from now on.
  void set_parameters(const PublisherSetup& parameters);
  PublisherSetup parameters() const;
  /// Grows with each set_parameters().
  std::uint64_t parameter_changes() const { return parameter_changes_; }
  /// Ends the thread; publish_now() no longer waits.
  void stop();
  std::vector<TopicRate> rates() const;
  /// What ended publishing, which ~status has said by then: a failure of the simulation, or of publishing.
  /// Empty while all is well.
  std::string failure() const;
  /// The reasons, by topic, why nothing could be published when it was last due: for local_map, that there is
  /// no transform.
  std::map<std::string, std::string> problems() const;

 private:
  /// What the thread has to do after it has slept.
  struct Work {
    bool all_changes = false;   ///< for publish_now(): every topic that has not shown the present state
    bool status = false;        ///< ~status was requested
    std::uint64_t request = 0;  ///< the calls of publish_now() that this serves
  };

  void run_thread();
  void publish_until_stopped();
  /// Sleeps until something is due or requested. None if the thread is to end.
  std::optional<Work> wait_for_work();
  bool any_topic_is_due(SteadyClock::time_point& next, bool& listen);
  void apply_new_parameters();
  std::vector<Topic*> due_topics(bool all_changes);
  std::vector<Topic*> ready_topics(const std::vector<Topic*>& due);
  void publish_topics(const std::vector<Topic*>& due, bool all_changes);
  void publish_status_if_due(const Work& work);
  void repeat_failure_status(const std::string& failure);

  SimulationThread& simulation_;

  /// Guards the members up to failure_, the writes to parameters_, the request of status_, and in each topic
  /// what TopicContext::mutex says.
  mutable std::mutex mutex_;
  std::condition_variable wake_up_, served_changed_;
  std::optional<PublisherSetup> new_parameters_;
  bool stopping_ = false;
  std::uint64_t requests_ = 0, served_ = 0;  ///< calls of publish_now()
  std::string failure_;

  std::atomic<bool> listens_to_changes_{false};
  std::atomic<std::uint64_t> parameter_changes_{0};

  // Used by the publishing thread alone, except for what the mutex guards:
  PublisherSetup parameters_;
  const TopicContext context_;
  StatusTopic status_;
  const TopicList topics_;
  std::uint64_t publications_ = 0;

  std::thread thread_;
};

}  // namespace desert_sim
