/// SimulationThread: the requests of other threads.

#include <chrono>
#include <cstdio>

#include "src/export/exported_terrain.hpp"
#include "src/io/terrain_files.hpp"
#include "src/ros/simulation/simulation_thread.hpp"
#include "src/scenario/raster_grid.hpp"
#include "src/simulation/checkpoint.hpp"
#include "src/simulation/memory/memory.hpp"

namespace desert_sim {

namespace {

constexpr double measure_duration = 5;  // [s] after a report

std::string busy_message(double seconds) {
  char text[200];
  std::snprintf(
      text, sizeof text,
      "the simulation has been busy with a step or another request for %g s (~answer_timeout); this "
      "request was withdrawn and has changed nothing",
      seconds);
  return text;
}

/// Of a command that has replaced the terrain.
const char* what_replaces(const Command& command) {
  if (std::holds_alternative<command::Reset>(command)) return "a reset";
  if (std::holds_alternative<command::Undo>(command)) return "an undo";
  return std::holds_alternative<command::Redo>(command) ? "a redo" : "a load";
}

/// The answer that finish() makes, once `begun` has a copy that is under way. finish() waits for that copy,
/// on the thread that asks for the answer.
template <class Answer, class PendingCopy, class Finish>
std::future<Answer> wait_for_copy(std::future<PendingCopy> begun, Finish finish) {
  return std::async(
      std::launch::deferred, [finish](std::future<PendingCopy> pending) { return finish(pending.get()); },
      std::move(begun));
}

}  // namespace

template <class R>
std::future<R> SimulationThread::submit(std::function<R()> body) {
  std::future<R> answer;
  const std::uint64_t job = jobs_.push(make_job<R>(std::move(body), answer));
  const double seconds = Patience::seconds();
  if (!(seconds > 0)) return answer;
  return std::async(
      std::launch::deferred,
      [this, job, seconds](std::future<R> pending) {
        const bool late =
            pending.wait_for(std::chrono::duration<double>(seconds)) == std::future_status::timeout;
        if (late && jobs_.withdraw(job)) throw ConfigError(busy_message(seconds));
        return pending.get();
      },
      std::move(answer));
}

std::future<ReachedState> SimulationThread::apply(const Command& command, bool with_hash, bool with_change) {
  return submit<ReachedState>([=] {
    const CommandResult result = session_->apply(command, with_change);
    ++commands_;
    stamp_ = stamp_now();
    if (result.replaces_terrain) {
      end_step_requests(what_replaces(command));
      ++terrains_;
      timed_steps_ = 0;
      pacer_.restart();
    }
    follow_rate();
    note_change();
    ReachedState r = reached(with_hash);
    r.result = result;
    return r;
  });
}

std::future<ReachedState> SimulationThread::step(std::uint32_t steps) {
  // Two promises: the job's, which only says that the request has been taken, and the request's own.
  auto request = std::make_shared<StepRequest>();
  request->requested = steps;
  std::future<ReachedState> answer = request->answer.get_future();
  Job job;
  job.run = [this, request] { step_requests_.push_back(std::move(*request)); };
  job.reject = [request](std::exception_ptr exception) { request->answer.set_exception(exception); };
  jobs_.push(std::move(job));
  return answer;
}

std::future<void> SimulationThread::pause() {
  return submit<void>([this] {
    end_step_requests("a pause");
    paused_ = true;
    pacer_.restart();
    wait_for_steps();
  });
}

std::future<void> SimulationThread::resume() {
  return submit<void>([this] {
    if (!paused_) return;
    paused_ = false;
    pacer_.restart();
    meter_.clear();
  });
}

std::future<void> SimulationThread::set_step_rate(double rate) {
  return submit<void>([this, rate] {
    step_rate_ = rate;
    follow_rate();
    waiting_for_clock_ = false;
  });
}

SimulationThread::PendingState SimulationThread::begin_state_copy(const std::vector<Layer>& layers,
                                                                  const RowBand& band,
                                                                  const StateQuery& query) {
  wait_for_steps();  // the stamp must be that of the state that is copied
  std::vector<Layer> in_use;
  for (Layer layer : layers) {
    note_request(layer);
    if (session_->simulation().views().shows(layer)) in_use.push_back(layer);
  }
  snapshot_requested_ = clock().seconds();
  ++snapshots_;
  Simulation& s = session_->simulation();
  PendingState state{moment(), s.views().begin_snapshot(in_use, band, query.feet),
                     {},       s.views().begin_costs(query.costs),
                     {},       {}};
  if (query.plants) state.plants = s.views().begin_plants();
  if (query.particle_paths > 0) state.particle_paths = s.views().begin_particle_paths(query.particle_paths);
  if (query.costs.update || query.costs.whole) costs_requested_ = clock().seconds();
  for (const auto& entry : query.held) note_request(entry.first);
  state.changes = s.views().begin_changes(query.held);
  return state;
}

void SimulationThread::note_request(Layer layer) {
  if (info(layer).lifetime == Lifetime::on_request) layers_requested_ = clock().seconds();
}

TerrainState SimulationThread::PendingState::get() const {
  TerrainState state{moment,       snapshot.get(),      {}, costs.update.get(), costs.whole.get(),
                     plants.get(), particle_paths.get()};
  for (const auto& [layer, pending] : changes) state.changes[layer] = pending.get();
  return state;
}

std::future<void> SimulationThread::forget(Layer layer) {
  return submit<void>([this, layer] { session_->simulation().views().forget(layer); });
}

std::future<TerrainState> SimulationThread::terrain(const std::vector<Layer>& layers, const RowBand& band,
                                                    const StateQuery& query) {
  return wait_for_copy<TerrainState>(
      submit<PendingState>([=] { return begin_state_copy(layers, band, query); }),
      [](const PendingState& state) { return state.get(); });
}

std::future<TerrainToSave> SimulationThread::terrain_to_save(const std::string& path) {
  struct PendingCopy {
    PendingState state;
    Scenario scenario;
    std::uint64_t hash;
  };
  return wait_for_copy<TerrainToSave>(
      submit<PendingCopy>([this, path] {
        session_->require_not_of_journal(path);
        const Simulation& s = session_->simulation();
        std::vector<Layer> layers = persistent_layers(s);
        layers.push_back(Layer::elevation);
        return PendingCopy{begin_state_copy(layers, {}, {}), s.scenario(), state_hash()};
      }),
      [](const PendingCopy& u) {
        return TerrainToSave{u.state.get(), u.scenario, u.hash};
      });
}

std::future<TerrainToExport> SimulationThread::terrain_to_export(const std::vector<std::string>& files) {
  struct PendingCopy {
    PendingState state;
    std::vector<std::string> rasters;
  };
  std::future<PendingCopy> begun = submit<PendingCopy>([this, files] {
    for (const std::string& file : files) session_->require_not_of_journal(file);
    StateQuery query;
    query.plants = true;
    return PendingCopy{begin_state_copy(layers_to_export(), {}, query),
                       raster_paths(session_->simulation().state().start)};
  });
  return wait_for_copy<TerrainToExport>(std::move(begun), [](const PendingCopy& u) {
    return TerrainToExport{u.state.get(), u.rasters};
  });
}

std::future<ScenarioToSave> SimulationThread::scenario_to_save(const std::string& path) {
  return submit<ScenarioToSave>([this, path] {
    session_->require_not_of_journal(path);
    session_->require_no_start_of_journal(parent_folder(path));
    wait_for_steps();
    const Simulation& s = session_->simulation();
    return ScenarioToSave{moment(), s.state().present_scenario(), checkpoint_bytes(s), state_hash()};
  });
}

std::future<ReachedState> SimulationThread::save_checkpoint(const std::string& path) {
  return submit<ReachedState>([=] {
    wait_for_steps();
    session_->save_checkpoint(path);
    return reached(true);
  });
}

std::future<CheckpointCopy> SimulationThread::checkpoint() {
  return submit<CheckpointCopy>([this] {
    wait_for_steps();
    return CheckpointCopy{moment(), checkpoint_bytes(session_->simulation()), session_->journal_files()};
  });
}

std::future<ForecastStart> SimulationThread::forecast_start(const ForecastParameters& options) {
  return submit<ForecastStart>([this, options] {
    wait_for_steps();
    const Simulation& s = session_->simulation();
    require_memory_for_forecast(s, options);
    return ForecastStart{moment(), checkpoint_bytes(s), s.exec().backend()};
  });
}

std::future<Scenario> SimulationThread::scenario_at_start() {
  return submit<Scenario>([this] { return session_->simulation().state().start; });
}

std::future<Scenario> SimulationThread::scenario() {
  return submit<Scenario>([this] { return session_->simulation().state().present_scenario(); });
}

std::future<StatusReport> SimulationThread::report(bool measure) {
  return submit<StatusReport>([this, measure] {
    wait_for_steps();
    Simulation& s = session_->simulation();
    StatusReport r;
    r.moment = moment();
    r.state = paused_ ? RunState::paused : (waiting_for_clock_ ? RunState::waiting : RunState::running);
    r.scenario = s.scenario().name;
    r.backend = s.exec().backend();
    r.backend_choice = backend_choice_;
    r.device = s.exec().device_name();
    r.time_step = s.scenario().run.time_step;
    r.parts = s.pipeline().parts();
    r.acceleration = s.scenario().run.acceleration;
    r.step_rate = pacer_.rate();
    r.steps_per_second = meter_.rate(clock().seconds());
    r.lag = pacer_.lag(clock_now());
    if (timed_steps_ > 0) {
      process_times_ = s.pipeline().times();
      for (ProcessTime& t : process_times_) t.milliseconds /= timed_steps_;
      s.pipeline().clear_times();
      timed_steps_ = 0;
    }
    r.process_times = process_times_;
    r.balance = s.state().balance();
    r.changes = s.commands().describe_changes();
    r.warnings = s.pipeline().warnings();
    r.wind_above = s.state().wind_above();
    r.undoable = session_->undoable();
    r.redoable = session_->redoable();
    r.snapshots = snapshots_;
    if (paused_ && step_requests_.empty()) {
      r.hashed = true;
      r.hash = state_hash();
    }
    r.layer_bytes = s.terrain().bytes();
    r.memory_available = s.exec().memory_available();
    r.memory_needed = static_cast<double>(total_bytes(s.memory()));
    if (measure) measure_until_ = clock().seconds() + measure_duration;
    return r;
  });
}

}  // namespace desert_sim
