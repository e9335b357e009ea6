#include "src/ros/simulation/simulation_thread.hpp"

#include <ros/console.h>

#include <algorithm>
#include <cmath>

#include "src/ros/simulation/autosave.hpp"
#include "src/ros/simulation/clock.hpp"
#include "src/ros/support/thread_priority.hpp"

namespace desert_sim {

namespace {

constexpr int max_steps_in_flight = 8;  // that a GPU may be behind before the thread waits for it
constexpr int timed_every = 16;         // steps from one that is timed to the next
constexpr double unused_memory_timeout =
    60;  // [s] for layers on request, costs and snapshots that nobody asks for

}  // namespace

SimulationThread::SimulationThread(const Scenario& scenario, const RasterLoader& load_raster,
                                   const Options& options, std::function<void()> on_change)
    : options_(options),
      on_change_(std::move(on_change)),
      step_rate_(options.step_rate),
      pacer_(options.step_rate),
      paused_(options.paused) {
  std::promise<void> started;
  std::future<void> ready = started.get_future();
  thread_ = std::thread([&] { run_thread(scenario, load_raster, started); });
  try {
    ready.get();
  } catch (...) {
    thread_.join();
    throw;
  }
}

SimulationThread::~SimulationThread() { stop(); }

void SimulationThread::stop() {
  jobs_.close("the simulation is ending");
  if (thread_.joinable()) thread_.join();
}

std::string SimulationThread::failure() const {
  const std::lock_guard<std::mutex> lock(failure_mutex_);
  return failure_;
}

// ---- On the simulation thread.

void SimulationThread::run_thread(const Scenario& scenario, const RasterLoader& load_raster,
                                  std::promise<void>& started) {
  set_name_and_niceness("simulation", options_.niceness);
  try {
    session_ = std::make_unique<Session>(scenario, load_raster, options_.backend, options_.threads,
                                         options_.journal, options_.undo_memory);
    backend_choice_ = session_->backend_choice();
    if (!options_.resume_from.empty())
      load_newest(*session_, options_.resume_from, options_.data_folder, options_.journal);
    session_->confine_commands(options_.data_folder);  // not before: a journal's checkpoint may lie elsewhere
    pacer_ = Pacer(wanted_rate());
    stamp_ = stamp_now();
    if (options_.publish_clock) options_.publish_clock(session_->simulation().state().paced_time());
  } catch (...) {
    session_.reset();
    started.set_exception(std::current_exception());
    return;
  }
  started.set_value();  // from here on, `scenario`, `load_raster` and `started` no longer exist
  try {
    loop();
  } catch (const std::exception& e) {
    fail(e.what());
  } catch (...) {
    fail("an exception of an unknown type was thrown");
  }
  const std::string reason =
      failure().empty() ? "the simulation is ending" : "the simulation has failed: " + failure();
  for (StepRequest& request : step_requests_)
    request.answer.set_exception(std::make_exception_ptr(Error(reason)));
  step_requests_.clear();
  session_.reset();
}

void SimulationThread::loop() {
  while (serve_jobs()) {
    release_unused_memory();
    if (!step_requests_.empty()) {
      serve_step_request();
    } else if (!paused_ && step_is_due()) {
      step();
      pacer_.stepped(wanted_rate());
    } else {
      wait_for_steps();
      jobs_.wait_for(std::chrono::duration<double>(idle_time()), clock());
    }
  }
}

/// How long there is nothing to do, unless a job comes [s].
double SimulationThread::idle_time() const {
  if (paused_) return 1.0;
  if (waiting_for_clock_) return 0.02;
  if (follows_ros_time())
    return 0.001;  // it is unknown when that clock will reach the due time: check again and again
  return std::min(0.1, std::max(1e-4, pacer_.until_due(clock_now())));
}

/// False if the thread is to end.
bool SimulationThread::serve_jobs() {
  for (Job job; jobs_.pop(job);) job.run();
  return !jobs_.closed();
}

void SimulationThread::serve_step_request() {
  StepRequest& request = step_requests_.front();
  if (request.done < request.requested) {
    step();
    ++request.done;
  }
  if (request.done < request.requested) return;
  ++commands_;
  follow_rate();                     // the timeline may have changed it
  pacer_.drop_backlog(clock_now());  // the time that these steps took is not to be caught up
  request.answer.set_value(reached(true));
  step_requests_.pop_front();
}

void SimulationThread::end_step_requests(const std::string& by) {
  for (StepRequest& request : step_requests_)
    request.answer.set_exception(std::make_exception_ptr(
        ConfigError("the request was ended by " + by + " after " + std::to_string(request.done) + " of " +
                    std::to_string(request.requested) + " steps")));
  step_requests_.clear();
}

/// Whether steps follow ROS time. A simulation that is the clock cannot wait for it.
bool SimulationThread::follows_ros_time() const { return ros::Time::isSimTime() && !options_.publish_clock; }

/// The stamp of the present state. A simulation that is the clock takes its own time: under use_sim_time, ROS
/// time only reaches it later.
ros::Time SimulationThread::stamp_now() const {
  return options_.publish_clock && ros::Time::isSimTime()
             ? clock_time(session_->simulation().state().paced_time())
             : ros::Time::now();
}

double SimulationThread::clock_now() const {
  return follows_ros_time() ? ros::Time::now().toSec() : clock().seconds();
}

/// How many steps a second of ROS time is to have [steps/s]; 0: as many as can be.
double SimulationThread::wanted_rate() const {
  const RunParameters& run = session_->simulation().scenario().run;
  return run.acceleration > 0 ? static_cast<double>(run.acceleration) / run.time_step : step_rate_.load();
}

void SimulationThread::follow_rate() {
  const double rate = wanted_rate();
  if (rate == pacer_.rate()) return;
  pacer_.change_rate(rate, clock_now());
  meter_.clear();
}

bool SimulationThread::step_is_due() {
  if (pacer_.rate() > 0 && follows_ros_time()) {
    const bool waiting = !ros::Time::isValid();
    if (waiting != waiting_for_clock_)
      ROS_INFO("%s", waiting ? "The simulation waits for the first message on /clock."
                             : "The first message on /clock has arrived.");
    waiting_for_clock_ = waiting;
    if (waiting) return false;
  }
  const bool due = pacer_.due(clock_now());
  if (pacer_.jumped_back()) ROS_WARN("ROS time has jumped back: the schedule of steps starts again.");
  const double lag = pacer_.lag(clock_now());
  if (lag > Pacer::backlog)
    ROS_WARN_THROTTLE(
        30,
        "The simulation is %.0f s behind its schedule: it makes %.1f steps per second, the target is %.1f.",
        lag, meter_.rate(clock().seconds()), pacer_.rate());
  return due;
}

void SimulationThread::step() {
  const double now = clock().seconds();
  const bool timed = now < measure_until_ && --steps_until_timed_ <= 0;
  if (timed) {
    wait_for_steps();
    steps_until_timed_ = timed_every;
    ++timed_steps_;
  }
  session_->simulation().pipeline().set_timing(timed);
  session_->step();
  if (++steps_in_flight_ >= max_steps_in_flight || pacer_.rate() > 0) wait_for_steps();
  stamp_ = stamp_now();
  meter_.count(clock().seconds());
  note_change();
}

/// Waits until all steps that were started are done.
void SimulationThread::wait_for_steps() {
  if (steps_in_flight_ == 0) return;
  session_->simulation().exec().synchronise();
  steps_in_flight_ = 0;
  stamp_ = stamp_now();
}

void SimulationThread::release_unused_memory() {
  const auto unused = [now = clock().seconds()](double& requested) {
    if (requested == 0 || now - requested < unused_memory_timeout) return false;
    requested = 0;
    return true;
  };
  if (unused(layers_requested_)) session_->simulation().views().release_requested_layers();
  if (unused(costs_requested_)) session_->simulation().views().forget_costs();
  if (unused(snapshot_requested_)) session_->simulation().views().staging().release();
}

void SimulationThread::note_change() {
  change_time_ = clock().now();
  ++changes_;
  if (options_.publish_clock) options_.publish_clock(session_->simulation().state().paced_time());
  on_change_();
}

Moment SimulationThread::moment() {
  const Simulation& s = session_->simulation();
  return {s.steps(), s.time(), stamp_, changes_, commands_, terrains_};
}

ReachedState SimulationThread::reached(bool with_hash) {
  wait_for_steps();
  ReachedState r;
  r.moment = moment();
  if (with_hash) r.hash = state_hash();
  return r;
}

/// The hash of the present state; it is computed only after a change.
std::uint64_t SimulationThread::state_hash() {
  if (hashed_change_ != changes_) hash_ = session_->simulation().state().hash();
  hashed_change_ = changes_;
  return hash_;
}

void SimulationThread::fail(const std::string& what) {
  {
    const std::lock_guard<std::mutex> lock(failure_mutex_);
    failure_ = what.empty() ? "the simulation failed" : what;
  }
  failed_ = true;
  jobs_.close("the simulation has failed: " + what);
  on_change_();
}

}  // namespace desert_sim
