#include "src/ros/topics/topic.hpp"

#include <ros/console.h>

#include <algorithm>

namespace desert_sim {

SteadyClock::duration period_of(double rate) {
  return rate > 0 ? std::chrono::duration_cast<SteadyClock::duration>(std::chrono::duration<double>(1 / rate))
                  : SteadyClock::duration::zero();
}

void SubscriberNames::remove(const std::string& name) {
  const auto found = count_.find(name);
  if (found != count_.end() && --found->second == 0) count_.erase(found);
}

bool SubscriberNames::is_subset_of(const SubscriberNames& others) const {
  return std::all_of(count_.begin(), count_.end(),
                     [&](const auto& entry) { return others.count_.count(entry.first) > 0; });
}

Topic::Topic(const TopicContext& context, const std::string& name)
    : context_(context), short_name_(name), name_(context.node.resolveName(name)) {}

// ---- From any thread.

void Topic::request() {
  const std::lock_guard<std::mutex> lock(context_.mutex);
  requested_ = true;
  context_.wake_up.notify_all();
}

void Topic::subscriber_joined(const std::string& subscriber, Topic& due) {
  const std::lock_guard<std::mutex> lock(context_.mutex);
  names_.add(subscriber);
  due.requested_ = true;
  context_.wake_up.notify_all();
}

void Topic::subscriber_left(const std::string& subscriber) {
  const std::lock_guard<std::mutex> lock(context_.mutex);
  names_.remove(subscriber);
}

TopicRate Topic::measured_rate() const {
  return {name_, follows_rate() ? rate() : 0, meter_.rate(context_.simulation.clock().seconds()),
          subscribers()};
}

// ---- On the publishing thread.

void Topic::count_message() {
  const std::lock_guard<std::mutex> lock(context_.mutex);
  meter_.count(context_.simulation.clock().seconds());
}

void Topic::mark_published(std::uint64_t change, std::uint64_t terrain, SteadyClock::time_point since) {
  published_change_ = change;
  published_terrain_ = terrain;
  shown_ = since;
  due_.published(since, may_be_early() ? context_.simulation.change_time() : since, period());
}

void Topic::rate_changed() { due_.period_changed(now(), period()); }

void Topic::set_problem(const std::string& problem) {
  if (!problem.empty()) ROS_WARN_THROTTLE(30, "%s: %s", short_name_.c_str(), problem.c_str());
  const std::lock_guard<std::mutex> lock(context_.mutex);
  problem_ = problem;
}

bool Topic::publish_or_set_problem(const std::function<void()>& publish) {
  std::string problem;
  try {
    publish();
  } catch (const ConfigError& e) {
    problem = e.what();
  }
  set_problem(problem);
  return problem.empty();
}

}  // namespace desert_sim
