#pragma once
/// A process as a value. One row says its name, its sections of parameters, the source of its equations, when
/// it is active, which layers it reads and writes, what it keeps between steps, and its step. From the rows
/// of src/simulation/processes follow the order of a step, the layers that are allocated, the plan of memory,
/// the times, the check for broken values, what is recomputed before somebody looks, what of a step can be
/// recorded, the cost model, the contract test, and the page config/processes.md.

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "kernels/field/layers.hpp"
#include "src/core/validation_errors.hpp"
#include "src/simulation/pipeline/shared_fields.hpp"
#include "src/simulation/state/state.hpp"

namespace desert_sim {

/// What the step of a process is given.
struct StepContext {
  SimulationState& state;
  SharedFields& fields;
  TerrainView terrain;
  bool leaves_heights = false;  ///< see Process::can_leave_heights
  int part = 0, parts = 1;      ///< of the step; see Process::longest_step

  Exec& exec() const { return state.exec(); }
  const Scenario& scenario() const { return state.scenario; }
  float time_step() const { return state.scenario.run.time_step / static_cast<float>(parts); }
  /// Number of steps, or parts of steps, before this one.
  std::uint64_t tick() const {
    return state.clock_origin.tick +
           (state.steps - state.clock_origin.step) * static_cast<std::uint64_t>(parts) +
           static_cast<std::uint64_t>(part);
  }
  double time() const { return time_of(tick()); }
  /// Of a tick since run.time_step last changed.
  double time_of(std::uint64_t tick) const {
    return state.clock_origin.time +
           static_cast<double>(tick - state.clock_origin.tick) * state.scenario.run.time_step / parts;
  }
  /// Whether a time begins for which layers are held, or there are none yet.
  bool renews_held_layers() const {
    const float hold = state.scenario.run.hold_time;
    if (!state.held_layers_known || time_step() >= hold || parts > 1) return true;
    const double held = hold;
    return state.steps > state.clock_origin.step &&
           std::floor(time() / held) > std::floor(time_of(tick() - 1) / held);
  }
  wind::Vector wind_above() const { return state.wind_above_at(time()); }
  const Dice& dice() const { return fields.dice; }
};

/// The data that a process keeps between steps: memory on the device, transforms, tables.
class ProcessWorkspace {
 public:
  virtual ~ProcessWorkspace() = default;
  virtual std::size_t bytes() const = 0;  ///< on the device
};

/// The fewest bytes that a process must move through memory in a step: every layer or field that a pass over
/// the grid reads or writes, once, four bytes a cell.
struct MemoryTraffic {
  double bytes = 0;  ///< a cell and step
  std::string reads, writes;
};

/// What a process is there for, where others could be in its place: each role has one active process.
enum class Role { wind, wind_shadow, sand_flux, sand_transport, repose, reptation, avalanching, water_flow };

struct Process {
  std::string name;
  std::vector<std::string> parameters;          ///< sections of the scenario
  std::string source;                           ///< of its equations
  std::string header;                           ///< where they stand in this repository
  std::function<bool(const Scenario&)> active;  ///< what the scenario says of it alone
  std::vector<Role> roles;
  bool gives_way = false;  ///< to an active process that has one of its roles, and does not give way
  /// Adds what of its parameters cannot be done in this scenario, where it takes part: a reach, or a number
  /// of sub-steps. Null if nothing.
  std::function<void(const Scenario&, ValidationErrors&)> check;

  /// Elevation up to which it may bring water or ground, as far as parameters tell [m]: heights are counted
  /// so that they reach it. Null if what the terrain begins with is all.
  std::function<double(const Scenario&)> highest;

  bool reads_heights = false;  ///< SharedFields::heights: the first in a step that does has them measured
  /// It measures them in passing for the next step, where no process after it moves ground or water
  /// (StepContext::leaves_heights).
  bool can_leave_heights = false;
  std::vector<SharedField> needs;  ///< of the fields that not all scenarios have
  std::vector<Layer> reads;        ///< where they are in use; those that it writes need not be repeated
  std::vector<Layer> writes;       ///< brought into use while it is active
  std::vector<Layer> writes_if_in_use;
  /// Fills a layer of `writes` that has just come into use, and is 0, with what it begins with. Null if that
  /// is 0.
  std::function<void(SimulationState&, Layer)> begin;

  /// Makes its workspace; null if it needs none. Throws ConfigError if there is no memory.
  std::function<std::unique_ptr<ProcessWorkspace>(const SimulationState&)> make_workspace;
  std::function<void(StepContext&, ProcessWorkspace*)> step;
  /// Longest step that it takes at once [s]. A longer one is divided into equal parts, in each of which all
  /// processes do their step, because what it changes acts back on it through them.
  std::function<float(const SimulationState&)> longest_step = [](const SimulationState&) {
    return std::numeric_limits<float>::infinity();
  };
  /// Recomputes, before somebody looks, what it derives from the state, which a loaded checkpoint does not
  /// have and changed parameters make stale; it changes no persistent layer. Null if it derives nothing.
  std::function<void(StepContext&, ProcessWorkspace*)> refresh;
  /// Brings its workspace up to date after a command that did not change parameters (wind features, loose
  /// ground). Throws ConfigError if there is no memory. Null if nothing can be stale.
  std::function<void(const SimulationState&, ProcessWorkspace*)> adapt;
  /// Names of its flags and of its counter in the state; a checkpoint's header has them under these.
  std::vector<std::string> flags;
  std::string counter;
  /// What the device has counted since `make_workspace`. Null if it counts nothing.
  std::function<std::uint64_t(const ProcessWorkspace&)> counted;
  /// Sets its flags after an edit of this layer, whether it is active or not. Null if it has none.
  std::function<void(SimulationState&, Layer)> edited;
  /// What the host counts after each step, also after one that was replayed from a recording. Null if
  /// nothing.
  std::function<void(StepContext&, ProcessWorkspace*)> after_step;
  /// What of its last step was otherwise than its header says, and what to do; empty if nothing. Null if
  /// that is never so.
  std::function<std::string(const SimulationState&, const ProcessWorkspace&)> warning;
  /// Whether its next step starts the same work on the device as others before and after it, and reads
  /// nothing back.
  std::function<bool(const SimulationState&)> can_be_recorded = [](const SimulationState&) { return true; };
  /// What else than parameters, memory and wind decides which work its next step starts. Null if nothing.
  std::function<std::uint64_t(const StepContext&)> recording_key;
  /// Of sand on bare rock with the default parameters. Null if the cost model does not have it.
  std::function<MemoryTraffic(const Scenario&, const Grid&)> traffic;

  bool may_write(Layer layer) const;
};

/// Of two active processes that are done in one pass where a rule says that it is faster. The bits are those
/// of one after the other.
struct FusedProcesses {
  std::string name;  ///< of the rule
  std::string first, second;
  std::function<bool(const SimulationState&)> applies;
  std::function<void(StepContext&, ProcessWorkspace* first, ProcessWorkspace* second)> step;
};

/// A workspace of type Work, which has a member bytes().
template <class Work>
class WorkspaceHolder final : public ProcessWorkspace {
 public:
  explicit WorkspaceHolder(Work made) : work(std::move(made)) {}
  std::size_t bytes() const override { return work.bytes(); }
  Work work;
};
template <class Work>
Work& workspace_as(ProcessWorkspace* workspace) {
  return static_cast<WorkspaceHolder<Work>&>(*workspace).work;
}
/// Gives `process` a workspace of type Work, which `make` creates and which its `step` gets.
template <class Work, class Make>
void set_workspace(Process& process, Make make) {
  process.make_workspace = [make](const SimulationState& state) {
    return std::make_unique<WorkspaceHolder<Work>>(make(state));
  };
}

}  // namespace desert_sim
