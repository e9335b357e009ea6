#pragma once
/// The thread that owns the simulation. Other threads ask it for something and wait for the answer; it serves
/// them between two steps. It holds no mutex during a step, a copy of the terrain, or an answer.

#include <atomic>
#include <chrono>
#include <deque>
#include <functional>
#include <future>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "src/core/monotonic_clock.hpp"
#include "src/ros/simulation/pacer.hpp"
#include "src/ros/simulation/terrain_state.hpp"
#include "src/ros/support/job_queue.hpp"
#include "src/simulation/session.hpp"

namespace desert_sim {

class SimulationThread {
 public:
  struct Options {
    std::string backend = "auto";
    int threads = 0;
    int niceness = 0;  ///< of the simulation's threads
    double step_rate =
        10;  ///< [steps/s]; 0: as fast as it can; of no effect while run.acceleration is above 0
    bool paused = false;
    std::string journal;                            ///< file, or empty
    std::size_t undo_memory = default_undo_memory;  ///< see Session [bytes]
    /// It starts from the first of these checkpoints that is complete, if there is one.
    std::vector<std::string> resume_from;
    std::string data_folder;  ///< that commands read files below; see Session::confine_commands()
    /// If set, the simulation is the clock of all nodes: this is called on the simulation thread with
    /// Simulation::paced_time() [s], at the start and after each step, and steps follow wall time, whatever
    /// use_sim_time says.
    std::function<void(double)> publish_clock;
    /// What the schedule of steps goes by where it does not follow ROS time. It outlives the simulation.
    const MonotonicClock* clock = &computer_clock();
  };

  /// While one of these lives, requests of its thread that the simulation has not begun to serve after
  /// `seconds` are withdrawn: their future then holds ConfigError, and they have changed nothing. Without
  /// one, or with 0 seconds, a request waits as long as a step or another request takes.
  class Patience {
   public:
    explicit Patience(double seconds) : outer_(std::exchange(seconds_, seconds)) {}
    ~Patience() { seconds_ = outer_; }
    Patience(const Patience&) = delete;
    Patience& operator=(const Patience&) = delete;
    static double seconds() { return seconds_; }

   private:
    static inline thread_local double seconds_ = 0;
    const double outer_;
  };

  /// Builds the terrain, and then runs. `on_change` is called on the simulation thread after each step and
  /// command, and when the simulation has failed; it must return quickly. Throws ConfigError.
  SimulationThread(const Scenario& scenario, const RasterLoader& load_raster, const Options& options,
                   std::function<void()> on_change);
  ~SimulationThread();

  // ---- Requests, from any thread. They return at once. The future holds ConfigError if the request was
  // refused and has changed nothing, and Error if the simulation ends or fails before it serves the request.

  /// `with_change`: the result of an edit has its change cell by cell.
  std::future<ReachedState> apply(const Command& command, bool with_hash = false, bool with_change = false);
  /// Makes exactly `steps` steps, as fast as possible. A pause, a reset or a load ends them early
  /// (ConfigError).
  std::future<ReachedState> step(std::uint32_t steps);
  std::future<void> pause();
  std::future<void> resume();
  /// Sets the rate [steps/s]; 0: as fast as possible. It has no effect while run.acceleration is above 0. The
  /// journal does not have this: it has no effect on the terrain.
  std::future<void> set_step_rate(double rate);
  /// A copy of layers (of a band of rows, if it has any), and of what `query` asks for. The simulation
  /// continues while the copy is under way: the thread that calls get() waits for it.
  std::future<TerrainState> terrain(const std::vector<Layer>& layers, const RowBand& band = {},
                                    const StateQuery& query = {});
  /// For a scenario file at `path`. Refused if the journal needs the file that is there: see
  /// Session::require_not_of_journal().
  std::future<TerrainToSave> terrain_to_save(const std::string& path);
  /// Likewise for all of these files.
  std::future<TerrainToExport> terrain_to_export(const std::vector<std::string>& files);
  std::future<ScenarioToSave> scenario_to_save(const std::string& path);
  /// Gives back what is kept of a layer for subscribers.
  std::future<void> forget(Layer layer);
  /// The scenario with the present parameters and the present wind regime.
  std::future<Scenario> scenario();
  std::future<Scenario> scenario_at_start();
  /// `measure`: processes are timed for a while from now on, which costs some speed.
  std::future<StatusReport> report(bool measure = true);
  std::future<ReachedState> save_checkpoint(const std::string& path);
  std::future<CheckpointCopy> checkpoint();
  /// Refused if there is no memory for such a forecast.
  std::future<ForecastStart> forecast_start(const ForecastParameters& options);

  /// The present counters of Moment: they tell whether a copy is still up to date.
  std::uint64_t changes() const { return changes_; }
  /// When the last of these changes was made.
  MonotonicClock::TimePoint change_time() const { return change_time_; }
  std::uint64_t commands() const { return commands_; }
  std::uint64_t terrains() const { return terrains_; }
  const MonotonicClock& clock() const { return *options_.clock; }
  double step_rate() const { return step_rate_; }  ///< as set, also while run.acceleration rules [steps/s]
  /// What ties a forecast to ROS time, see ForecastOptions [steps/s]. A simulation that is the clock of all
  /// nodes is not tied by its rate.
  double forecast_step_rate() const {
    return options_.publish_clock && ros::Time::isSimTime() ? 0 : step_rate_.load();
  }
  const std::string& backend_choice() const { return backend_choice_; }

  /// What ended the simulation; empty while it lives.
  std::string failure() const;
  bool failed() const { return failed_; }
  /// Failed or stopped.
  bool ended() const { return jobs_.closed(); }
  /// Ends the thread after the present step. Requests that wait then hold Error.
  void stop();

 private:
  struct StepRequest {
    std::uint32_t requested = 0, done = 0;
    std::promise<ReachedState> answer;
  };

  template <class R>
  std::future<R> submit(std::function<R()> body);
  void run_thread(const Scenario& scenario, const RasterLoader& load_raster, std::promise<void>& started);
  void loop();
  bool serve_jobs();
  void serve_step_request();
  void end_step_requests(const std::string& by);
  bool step_is_due();
  double wanted_rate() const;
  void follow_rate();
  void step();
  void wait_for_steps();
  /// Releases memory that holds what has not been asked for in a while.
  void release_unused_memory();
  void note_change();
  /// A TerrainState whose copies are under way.
  struct PendingState {
    Moment moment;
    PendingSnapshot snapshot;
    PendingChanges changes;
    PendingCosts costs;
    PendingPlants plants;
    PendingParticlePaths particle_paths;
    TerrainState get() const;
  };
  PendingState begin_state_copy(const std::vector<Layer>& layers, const RowBand& band,
                                const StateQuery& query);
  void note_request(Layer layer);
  Moment moment();
  ReachedState reached(bool with_hash);
  std::uint64_t state_hash();
  double idle_time() const;
  void fail(const std::string& what);
  bool follows_ros_time() const;
  double clock_now() const;
  ros::Time stamp_now() const;

  const Options options_;
  const std::function<void()> on_change_;
  JobQueue jobs_;
  std::atomic<std::uint64_t> changes_{1}, commands_{0}, terrains_{0};
  std::atomic<MonotonicClock::TimePoint> change_time_{};
  std::string backend_choice_;
  std::atomic<double> step_rate_;
  std::atomic<bool> failed_{false};
  mutable std::mutex failure_mutex_;  ///< guards failure_
  std::string failure_;

  // Used by the simulation thread alone, and without a mutex:
  std::unique_ptr<Session> session_;
  std::deque<StepRequest> step_requests_;
  Pacer pacer_;
  RateMeter meter_;
  ros::Time stamp_;
  bool paused_, waiting_for_clock_ = false;
  int steps_in_flight_ = 0;  ///< started on the device, and perhaps not done yet
  std::uint64_t snapshots_ = 0;
  /// When layers that exist on request, costs, and snapshots were last asked for [s]; 0 if no memory is held
  /// for them.
  double layers_requested_ = 0, costs_requested_ = 0, snapshot_requested_ = 0;
  // Timing: while somebody asks for reports, some steps are timed, process by process.
  double measure_until_ = 0;
  int steps_until_timed_ = 0, timed_steps_ = 0;
  std::vector<ProcessTime> process_times_;
  std::uint64_t hashed_change_ = 0, hash_ = 0;

  std::thread thread_;
};

}  // namespace desert_sim
