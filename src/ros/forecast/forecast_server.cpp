#include "src/ros/forecast/forecast_server.hpp"

#include <ros/console.h>

#include <boost/make_shared.hpp>
#include <future>
#include <utility>

#include "src/ros/forecast/forecast_messages.hpp"
#include "src/ros/forecast/forecast_request.hpp"
#include "src/ros/support/thread_priority.hpp"

namespace desert_sim {

namespace {

constexpr auto poll_period = std::chrono::milliseconds(20), feedback_period = std::chrono::milliseconds(100);

/// Steps and publishing come before a forecast. With SCHED_IDLE none came to its end on a busy machine, and
/// planners that waited for one stood still.
constexpr int niceness = 15;

/// Calls `work` on a thread of its own, to which others are preferred.
template <class Work>
auto in_background(Work work) {
  return std::async(std::launch::async, [work = std::move(work)]() mutable {
    set_name_and_niceness("forecast", niceness);
    return work();
  });
}

bool cancel_was_requested(unsigned status) {
  return status == actionlib_msgs::GoalStatus::RECALLING || status == actionlib_msgs::GoalStatus::PREEMPTING;
}

ForecastTerrainResult failure_result(const std::string& reason) {
  ForecastTerrainResult result;
  result.message = reason;
  return result;
}

}  // namespace

ForecastServer::ForecastServer(const ros::NodeHandle& node, SimulationThread& simulation,
                               const TopicPublisher& publisher, const Frames& frames, int threads,
                               double answer_timeout)
    : simulation_(simulation),
      publisher_(publisher),
      frames_(frames),
      threads_(threads),
      answer_timeout_(answer_timeout),
      server_(
          node, "forecast", [this](const GoalHandle& goal) { take_goal(goal); },
          [](const GoalHandle&) {}) {  // the thread sees it in the goal's status
  ros::NodeHandle topics(node, "forecast");
  const auto joined = [this](const ros::SingleSubscriberPublisher&) {
    const std::lock_guard<std::mutex> lock(mutex_);
    new_subscriber_ = true;
    wake_up_.notify_all();
  };
  maps_ = topics.advertise<Forecast>("maps", 1, joined);
  costmap_ = topics.advertise<nav_msgs::OccupancyGrid>("costmap", 1, joined);
  thread_ = std::thread([this] { run_thread(); });
  if (maps_ && costmap_) server_.start();  // otherwise ROS is shutting down and advertises nothing
}

ForecastServer::~ForecastServer() { stop(); }

void ForecastServer::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
    wake_up_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

ForecastReport ForecastServer::report() const {
  const double wanted = has_subscribers() ? publisher_.parameters().topics.forecast_rate : 0;
  const std::lock_guard<std::mutex> lock(mutex_);
  ForecastReport report = report_;
  report.wanted_rate = wanted;
  return report;
}

void ForecastServer::note_done(double seconds, const std::string& error) {
  const std::lock_guard<std::mutex> lock(mutex_);
  report_.error = error;
  if (!error.empty()) return;
  ++report_.done;
  report_.seconds = seconds;
}

// ---- Goals, on threads of the callback queue.

void ForecastServer::take_goal(GoalHandle handle) {
  Goal goal{handle, {}};
  try {
    const SimulationThread::Patience patience(answer_timeout_);
    goal.options = forecast_options(
        *handle.getGoal(), {simulation_.scenario().get(), publisher_.parameters(), simulation_.step_rate()},
        simulation_.forecast_step_rate());
  } catch (const std::exception& e) {
    const std::string reason = limited_message(e.what());
    handle.setRejected(failure_result(reason), reason);
    return;
  }
  std::optional<Goal> displaced = std::move(goal);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!stopping_) std::swap(displaced, next_);
    wake_up_.notify_all();
  }
  if (!displaced) return;
  const std::string reason = "a newer goal, or the end of the node, came before this one was begun";
  displaced->handle.setCanceled(failure_result(reason), reason);
}

// ---- On the thread.

void ForecastServer::run_thread() {
  set_name_and_niceness("forecasts", 0);
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopping_) {
    if (next_) {
      Goal goal = *std::exchange(next_, std::nullopt);
      lock.unlock();
      serve(goal);
      lock.lock();
      continue;
    }
    lock.unlock();
    const bool due = topics_are_due();
    if (due) publish_topics();
    lock.lock();
    if (!due && !stopping_ && !next_) wake_up_.wait_for(lock, feedback_period);
  }
  if (next_) next_->handle.setRejected(failure_result("the node is ending"), "the node is ending");
  next_.reset();
}

/// Why a forecast has to end early, if it has to.
std::optional<ForecastServer::Ended> ForecastServer::must_end(const Goal* goal, std::uint64_t terrain) const {
  if (goal && cancel_was_requested(goal->handle.getGoalStatus().status)) return Ended{"cancelled", true};
  if (simulation_.ended()) return Ended{"the simulation has ended"};
  if (simulation_.terrains() != terrain) return Ended{"a reset or a load has replaced the terrain"};
  const std::lock_guard<std::mutex> lock(mutex_);
  if (stopping_) return Ended{"the node is ending"};
  if (next_) return Ended{"preempted by a newer goal", true};
  return {};
}

ForecastServer::Outcome ForecastServer::make_forecast(const ForecastOptions& options, Goal* goal) {
  const Clock::time_point begun = simulation_.clock().now();
  ForecastStart start = simulation_.forecast_start(options).get();
  if (!goal) shown_change_ = start.moment.change;
  std::unique_ptr<ForecastRun> run =
      in_background([&] {
        return std::make_unique<ForecastRun>(std::move(start.checkpoint), options, start.backend, threads_);
      }).get();
  if (goal) {
    goal->handle.setAccepted();
    goal->accepted = true;
  }
  std::atomic<bool> go_on{true};
  std::atomic<int> member{0};
  std::atomic<double> time{0};
  std::future<std::optional<ForecastMaps>> maps = in_background([&] {
    return run->run([&](int now, double reached) {
      member = now;
      time = reached;
      return go_on.load();
    });
  });
  const struct EndsIt {
    std::atomic<bool>& go_on;
    ~EndsIt() { go_on = false; }  // or the future would wait for the horizon if the rest throws
  } ends_it{go_on};
  Ended ended;
  Clock::time_point told = begun;
  while (maps.wait_for(poll_period) != std::future_status::ready) {
    if (const std::optional<Ended> end = must_end(goal, start.moment.terrain); go_on && end) {
      ended = *end;
      go_on = false;
    }
    if (!goal || simulation_.clock().now() - told < feedback_period) continue;
    told = simulation_.clock().now();
    ForecastTerrainFeedback feedback;
    feedback.member = static_cast<std::uint32_t>(member.load());
    feedback.time = time;
    feedback.progress = static_cast<float>((member + time / options.horizon) / options.members);
    goal->handle.publishFeedback(feedback);
  }
  std::optional<ForecastMaps> made = maps.get();
  run.reset();
  if (!made) return {nullptr, ended};
  ForecastPtr message = forecast_message(std::move(*made), start.moment, frames_.terrain_frame());
  note_done(std::chrono::duration<double>(simulation_.clock().now() - begun).count(), "");
  return {message, {}};
}

void ForecastServer::serve(Goal& goal) {
  const auto end = [&goal](const std::string& reason) {
    const ForecastTerrainResult result = failure_result(reason);
    if (goal.accepted)
      goal.handle.setAborted(result, reason);
    else
      goal.handle.setRejected(result, reason);
  };
  try {
    const Outcome outcome = make_forecast(goal.options, &goal);
    if (outcome.forecast) {
      ForecastTerrainResult result;
      result.success = true;
      result.forecast = std::move(*outcome.forecast);
      goal.handle.setSucceeded(result);
    } else if (outcome.ended.cancelled) {
      goal.handle.setCanceled(failure_result(outcome.ended.reason), outcome.ended.reason);
    } else {
      end(outcome.ended.reason);
    }
  } catch (const ConfigError& e) {
    end(e.what());
  } catch (const std::exception& e) {
    end(limited_message(e.what()));
    if (simulation_.ended()) return;  // which ~status says
    ROS_ERROR("The forecast failed: %s", e.what());
    note_done(0, e.what());
  }
}

// ---- The topics.

bool ForecastServer::topics_are_due() const {
  if (!has_subscribers() || !(publisher_.parameters().topics.forecast_rate > 0)) return false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (new_subscriber_) return true;
  }
  return simulation_.clock().now() >= due_.time() && simulation_.changes() != shown_change_;
}

void ForecastServer::publish_topics() {
  const PublisherParameters topics = publisher_.parameters().topics;
  const Clock::time_point begun = simulation_.clock().now();
  due_.published(begun, begun, period_of(topics.forecast_rate));
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    new_subscriber_ = false;
  }
  ForecastOptions options;
  options.horizon = topics.forecast_horizon;
  options.moments = topics.forecast_moments;
  options.stride = topics.forecast_stride;
  options.step_rate = simulation_.forecast_step_rate();
  try {
    const Outcome outcome = make_forecast(options, nullptr);
    if (!outcome.forecast) {
      due_.period_changed(simulation_.clock().now(), {});  // at once, after what has ended it
      shown_change_ = 0;
      return;
    }
    const Clock::time_point now = simulation_.clock().now();
    costmap_.publish(boost::make_shared<nav_msgs::OccupancyGrid>(outcome.forecast->costs.back()));
    maps_.publish(outcome.forecast);
    const std::lock_guard<std::mutex> lock(mutex_);
    if (last_published_ != Clock::time_point())
      report_.achieved_rate = 1 / std::chrono::duration<double>(now - last_published_).count();
    last_published_ = now;
  } catch (const std::exception& e) {
    if (simulation_.ended()) return;  // which ~status says
    ROS_ERROR_THROTTLE(30, "~forecast/maps: %s", e.what());
    note_done(0, e.what());
  }
}

}  // namespace desert_sim
