#pragma once
/// ~forecast: the action that runs ahead on a copy of the simulation, and the topics ~forecast/maps and
/// ~forecast/costmap with forecasts at a rate.
///
/// One thread serves them, one forecast at a time: goals first, and the newest goal ends what runs. It copies
/// the present state between two steps of the simulation; the copy's steps are made by threads of the lowest
/// priority (on a GPU in a stream of the lowest), which hold no lock that others wait for.

#include <desert_sim/ForecastTerrainAction.h>
#include <ros/node_handle.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "src/ros/conversion/frames.hpp"
#include "src/ros/simulation/simulation_thread.hpp"
#include "src/ros/support/action_server.hpp"
#include "src/ros/topics/topic_publisher.hpp"
#include "src/simulation/forecast/forecast.hpp"

namespace desert_sim {

/// What /diagnostics says.
struct ForecastReport {
  std::uint64_t done = 0;    ///< forecasts, of goals and topics
  double seconds = 0;        ///< of wall time that the last one took
  double wanted_rate = 0;    ///< of the topics, if anybody subscribes [Hz]
  double achieved_rate = 0;  ///< of the topics [Hz]; 0 before the second forecast
  std::string error;         ///< why the last one failed; empty if it did not, or was only refused or ended
};

class ForecastServer {
 public:
  /// `node` is private to the node; other threads must serve its callback queue. `threads`: of the CPU
  /// backend. `answer_timeout`: see SimulationThread::Patience.
  ForecastServer(const ros::NodeHandle& node, SimulationThread& simulation, const TopicPublisher& publisher,
                 const Frames& frames, int threads, double answer_timeout);
  ~ForecastServer();
  /// Ends the forecast that runs after its present step, and takes no goals any more.
  void stop();
  ForecastReport report() const;

 private:
  using Clock = std::chrono::steady_clock;
  using GoalHandle = ActionServer<ForecastTerrainAction>::GoalHandle;
  struct Goal {
    GoalHandle handle;
    ForecastOptions options;
    bool accepted = false;
  };
  /// Why a forecast was ended.
  struct Ended {
    std::string reason;
    bool cancelled = false;  ///< by a cancel, or by another goal: the action calls that preempted
  };
  /// A forecast, or why there is none.
  struct Outcome {
    ForecastPtr forecast;
    Ended ended;
  };

  void take_goal(GoalHandle handle);
  void run_thread();
  void serve(Goal& goal);
  void publish_topics();
  /// `goal` is null for the topics. Throws what a forecast is refused for, or fails with.
  Outcome make_forecast(const ForecastOptions& options, Goal* goal);
  std::optional<Ended> must_end(const Goal* goal, std::uint64_t terrain) const;
  bool topics_are_due() const;
  bool has_subscribers() const { return maps_.getNumSubscribers() > 0 || costmap_.getNumSubscribers() > 0; }
  void note_done(double seconds, const std::string& error);

  SimulationThread& simulation_;
  const TopicPublisher& publisher_;
  const Frames& frames_;
  const int threads_;
  const double answer_timeout_;  ///< [s]

  mutable std::mutex mutex_;  ///< guards the members up to report_
  std::condition_variable wake_up_;
  std::optional<Goal> next_;  ///< to be served
  bool stopping_ = false, new_subscriber_ = false;
  ForecastReport report_;

  // Of the thread alone:
  DueTime due_;  ///< of the topics
  Clock::time_point last_published_;
  std::uint64_t shown_change_ = 0;  ///< that the topics begin with

  ros::Publisher maps_, costmap_;
  ActionServer<ForecastTerrainAction> server_;
  std::thread thread_;
};

}  // namespace desert_sim
