#pragma once
/// ~status: what the simulation does, and why it has ended. It shows a StatusReport and not the terrain, and
/// is still published when the simulation has failed; so it is no Topic.

#include <desert_sim/SimulationStatus.h>
#include <ros/publisher.h>

#include <string>

#include "src/ros/topics/topic.hpp"

namespace desert_sim {

class StatusTopic {
 public:
  explicit StatusTopic(const TopicContext& context);

  bool has_subscribers() const { return publisher_.getNumSubscribers() > 0; }
  /// Makes it due: for a new subscriber, or after a change that is no step. From any thread.
  void request();

  // The caller holds the mutex of the context:
  bool is_requested() const { return requested_; }
  /// Whether it was requested; from then on it is not.
  bool consume_request();

  // For the publishing thread alone:
  bool is_due_by_rate() const { return rate() > 0 && now() >= due_.time(); }
  /// When it is due by its rate, which must be above 0.
  SteadyClock::time_point due_time() const { return due_.time(); }
  double rate() const { return context_.parameters.topics.status_rate; }
  /// The rate may have changed: it is due a period from now at the latest.
  void rate_changed();
  /// `publications`: messages of topics so far.
  void publish(const StatusReport& report, std::uint64_t publications);
  /// Publishes the last status again, as an error with this reason.
  void publish_failure(const std::string& reason);

 private:
  SteadyClock::time_point now() const { return context_.simulation.clock().now(); }

  const TopicContext& context_;
  ros::Publisher publisher_;
  DueTime due_;
  SimulationStatus last_;
  bool requested_ = false;  ///< guarded by the mutex of the context
};

}  // namespace desert_sim
