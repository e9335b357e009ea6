#pragma once
/// The pipeline: the processes of a scenario in their order, with what they keep. The list is made when the
/// scenario is set or changed; a step is a loop over it.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "src/simulation/pipeline/memory_part.hpp"
#include "src/simulation/pipeline/process_table.hpp"
#include "src/simulation/pipeline/step_recordings.hpp"

namespace desert_sim {

/// Milliseconds of one process since the times were cleared.
struct ProcessTime {
  std::string process;
  double milliseconds = 0;
};

class Pipeline {
 public:
  /// For the present scenario of `state`. Throws ConfigError if there is no memory.
  Pipeline(SimulationState& state, ProcessTable table);

  /// Makes the list, the layers in use, and what the processes keep anew: after parameters have changed, and
  /// when the device is idle. Throws ConfigError if there is no memory; prepare() with the former scenario
  /// then restores it.
  void prepare();
  /// After a command that did not change parameters; see Process::adapt.
  void adapt();
  /// The ground was changed by somebody else than a process.
  void ground_changed() { fields_.heights_stale = true; }
  /// An edit, or its undo, changes this layer; see Process::edited.
  void edited(Layer layer);
  /// Whether an active process writes the layer.
  bool writes(Layer layer) const;
  /// Derived layers are not those of the state any more.
  void derived_changed() { derived_ready_ = false; }

  /// One step of all active processes. Throws StateError if a process breaks a layer.
  void step();
  /// Number of equal parts in which a step is done: none is longer than Process::longest_step, or than the
  /// shortest time between rows of a wind series.
  int parts() const;
  /// The clock of the first part of the next step.
  struct PartClock {
    std::uint64_t tick;
    float time_step;  ///< [s]
    wind::Vector wind_above;
  };
  PartClock next_part();
  /// The step of one active process alone, for tests.
  void step_alone(const std::string& process);
  /// Brings derived layers and the angles of repose up to date, where no step has.
  void refresh_derived();

  /// Timing waits for the device after each process; off by default.
  void set_timing(bool on) { timing_ = on; }
  std::vector<ProcessTime> times() const;
  void clear_times();

  SharedFields& fields() { return fields_; }
  /// What the processes keep, and the fields that they share, on the device.
  std::vector<MemoryPart> memory() const;
  std::uint64_t count(const std::string& counter) const;  ///< of all steps; see Process::counter
  double mean_count(const std::string& counter) const;    ///< of a step
  /// Of the last step, by process; see Process::warning.
  std::map<std::string, std::string> warnings() const;

  /// A process of this scenario.
  struct Stage {
    const Process* process;
    std::unique_ptr<ProcessWorkspace> workspace;
    double milliseconds = 0;  ///< since the times were cleared
    bool timed = false;
  };
  const std::vector<Stage>& stages() const { return stages_; }
  /// What steps that nobody observes run in the place of stages(): fused where a rule says so.
  std::vector<std::string> launch_names() const;
  /// How many of these, from the first on, are recorded once and replayed.
  std::size_t recordable_stages() const;

 private:
  /// One or two stages that are started together.
  struct Launch {
    Stage* stage;
    Stage* second = nullptr;
    const FusedProcesses* fused = nullptr;
    bool measures_heights = false;  ///< the first of a step that reads them
  };
  StepContext context();
  void run_part(StepContext& context);
  std::vector<std::uint64_t> recording_keys(const StepContext& context) const;
  void make_launches();
  bool reads_heights() const;  ///< some process of this scenario does
  void measure_heights(StepContext& context);
  void allocate_layers();
  void bring_into_use(const Process& process, Layer layer);
  void run(const Launch& launch, StepContext& context);
  void run_observed(const Launch& launch, StepContext& context);
  void check(const Process& process, Layer layer) const;
  bool checks_layers() const;
  Stage* find(const std::string& process);

  SimulationState& state_;
  const ProcessTable table_;
  SharedFields fields_;
  std::vector<Stage> stages_;
  std::vector<Launch> unfused_launches_, fused_launches_;
  bool leaves_heights_ = false;  ///< the last process that moves ground measures them
  bool derived_ready_ = false;
  StepRecordings recordings_;
  bool timing_ = false;
};

}  // namespace desert_sim
