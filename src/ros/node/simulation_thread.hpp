#pragma once
/// The one thread that owns the simulation. Other threads ask it for something and wait for the answer; it
/// serves them between steps. A step, a copy of the terrain or an answer never happens under a lock.

#include <atomic>
#include <deque>
#include <functional>
#include <future>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "src/ros/node/job_queue.hpp"
#include "src/ros/node/moment.hpp"
#include "src/ros/node/pacer.hpp"
#include "src/simulation/session.hpp"

namespace desert_sim {

class SimulationThread {
 public:
  struct Options {
    std::string backend = "auto";
    int threads = 0;
    int niceness = 0;       ///< of the simulation's threads
    double step_rate = 10;  ///< [steps/s]; 0: as fast as it can
    bool paused = false;
    std::string journal;  ///< file, or empty
    /// Begin with the first of these checkpoints that is whole, if there is one.
    std::vector<std::string> resume_from;
    /// See Session::check_with().
    std::function<void(const Scenario&)> check_scenario;
    /// Called on the simulation thread with the simulated time [s], at the start and after each step. With
    /// it, the simulation is the clock: it follows wall time, whatever use_sim_time says.
    std::function<void(double)> publish_clock;
  };

  /// Builds the terrain, and then runs. `on_change` is called on the simulation thread after each step and
  /// command, and when the simulation has failed; it must be quick. Throws ConfigError.
  SimulationThread(const Scenario& scenario, const RasterLoader& load_raster, const Options& options,
                   std::function<void()> on_change);
  ~SimulationThread();

  // All of these return at once. The future holds ConfigError if the request was refused and has changed
  // nothing, Error if the simulation ends or has failed before it is served.

  /// `with_change`: the result of an edit tells it cell by cell.
  std::future<Reached> apply(const Command& command, bool with_hash = false, bool with_change = false);
  /// Exactly `steps` steps, as fast as it can. Ended early (ConfigError) by a pause, a reset or a load.
  std::future<Reached> step(std::uint32_t steps);
  std::future<void> pause();
  std::future<void> resume();
  /// [steps/s]; 0: as fast as it can. The schedule begins anew. Not journalled: the terrain does not feel it.
  std::future<void> set_step_rate(double rate);
  /// The simulation goes on while the copy is under way: who calls get() waits for the copy there.
  std::future<TerrainState> terrain(const std::vector<Layer>& layers, const RowBand& band = {},
                                    const StateQuery& held = {});
  std::future<TerrainToSave> terrain_to_save();
  /// With the parameters and the wind regime of now.
  std::future<Scenario> scenario();
  /// With `measure`, processes are timed for a while, which costs some speed.
  std::future<StatusReport> report(bool measure = true);
  std::future<Reached> save_checkpoint(const std::string& path);
  std::future<CheckpointCopy> checkpoint();

  /// Counters of Moment, of what has been done; for deciding whether a copy is still good.
  std::uint64_t changes() const { return changes_; }
  std::uint64_t commands() const { return commands_; }
  std::uint64_t terrains() const { return terrains_; }
  double step_rate() const { return step_rate_; }  ///< wanted [steps/s]
  const std::string& backend_choice() const { return backend_choice_; }

  /// What ended the simulation; empty while it lives.
  std::string failure() const;
  bool failed() const { return failed_; }
  /// Failed or stopped.
  bool ended() const { return jobs_.closed(); }
  /// Ends the thread, after the step that it is in; requests that wait hold Error then.
  void stop();

 private:
  struct StepRequest {
    std::uint32_t asked = 0, done = 0;
    std::promise<Reached> answer;
  };

  template <class R>
  std::future<R> ask(std::function<R()> body);
  void thread(const Scenario& scenario, const RasterLoader& load_raster, std::promise<void>& started);
  void loop();
  bool serve_jobs();
  void serve_step_request();
  void end_step_requests(const std::string& by);
  bool step_is_due();
  void step();
  void settle();
  /// Of what has not been asked for in a while.
  void release_unused_memory();
  void changed();
  struct StateUnderWay {
    Moment moment;
    PendingSnapshot snapshot;
    Pending<ElevationChanges> changes;
    TakenCosts costs;
    PendingPlants plants;
    TerrainState get() const;
  };
  StateUnderWay begin_state(const std::vector<Layer>& layers, const RowBand& band, const StateQuery& held);
  Moment moment();
  Reached reached(bool with_hash);
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
  std::string backend_choice_;
  std::atomic<double> step_rate_;
  std::atomic<bool> failed_{false};
  mutable std::mutex failure_mutex_;
  std::string failure_;

  // Below: of the simulation thread alone.
  std::unique_ptr<Session> session_;
  std::deque<StepRequest> step_requests_;
  Pacer pacer_;
  RateMeter meter_;
  ros::Time stamp_;
  bool paused_, waiting_for_clock_ = false;
  int unsettled_steps_ = 0;
  std::uint64_t snapshots_ = 0;
  /// When layers that exist on request, costs and snapshots were last asked for [s]; 0: they have no memory.
  double layers_requested_ = 0, costs_requested_ = 0, snapshot_requested_ = 0;
  // Measuring: now and then a step is timed, process by process, while somebody looks at reports.
  double measure_until_ = 0;
  int steps_until_timed_ = 0, timed_steps_ = 0;
  std::vector<ProcessTime> process_times_;
  std::uint64_t hashed_change_ = 0, hash_ = 0;

  std::thread thread_;
};

}  // namespace desert_sim
