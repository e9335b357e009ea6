#include "src/simulation/pipeline/pipeline.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "kernels/backend/exec.hpp"
#include "kernels/field/statistics.hpp"
#include "src/core/error.hpp"

namespace desert_sim {

bool Process::may_write(Layer layer) const {
  const auto has = [layer](const std::vector<Layer>& layers) {
    return std::find(layers.begin(), layers.end(), layer) != layers.end();
  };
  return has(writes) || has(writes_if_in_use);
}

Pipeline::Pipeline(SimulationState& state, ProcessTable table)
    : state_(state), table_(std::move(table)), fields_(state.exec(), state.terrain.grid()) {
  prepare();
}

// ---- making the list

void Pipeline::prepare() {
  recordings_.forget();
  for (const Stage& stage : stages_)
    if (const std::string& counter = stage.process->counter; !counter.empty())
      state_.counts[counter] = count(counter);
  allocate_layers();
  std::set<SharedField> needed;
  for (const Process& process : table_.processes)
    if (table_.is_active(process, state_.scenario)) needed.insert(process.needs.begin(), process.needs.end());
  fields_.prepare(state_.exec(), state_.terrain.grid(), needed);
  std::vector<Stage> before = std::move(stages_);
  stages_.clear();
  unfused_launches_.clear();
  fused_launches_.clear();
  stages_.reserve(table_.processes.size());
  for (const Process& process : table_.processes) {
    if (!table_.is_active(process, state_.scenario)) continue;
    Stage stage{&process, process.make_workspace ? process.make_workspace(state_) : nullptr};
    // What the process kept before goes once its successor is there, not with all others': less memory at a
    // time.
    for (Stage& former : before)
      if (former.process == &process) {
        stage.milliseconds = former.milliseconds;
        stage.timed = former.timed;
        former.workspace.reset();
      }
    stages_.push_back(std::move(stage));
  }
  make_launches();
  derived_ready_ = false;
  fields_.heights_stale = true;
}

/// A derived layer is there only while a process that writes it is active: others take its absence for
/// "none". What lies in persistent layers stays there when their process is switched off.
void Pipeline::allocate_layers() {
  std::vector<Layer> unused;
  for (const Process& process : table_.processes)
    for (Layer layer : process.writes) {
      if (table_.is_active(process, state_.scenario))
        bring_into_use(process, layer);
      else if (info(layer).lifetime == Lifetime::derived || info(layer).lifetime == Lifetime::held)
        unused.push_back(layer);
    }
  for (Layer layer : unused) {
    const bool used = std::any_of(table_.processes.begin(), table_.processes.end(), [&](const Process& p) {
      return table_.is_active(p, state_.scenario) && std::count(p.writes.begin(), p.writes.end(), layer) > 0;
    });
    if (!used) state_.terrain.set_allocated(layer, false);
  }
  state_.held_layers_known = state_.held_layers_known && state_.has_held_layers();
}

void Pipeline::bring_into_use(const Process& process, Layer layer) {
  const bool planned = state_.exec().device() == Device::none;  // memory that nothing may touch
  const bool fresh = !state_.terrain.has(layer);
  state_.terrain.allocate(layer);
  if (fresh && process.begin && !planned) process.begin(state_, layer);
}

void Pipeline::make_launches() {
  unfused_launches_.clear();
  fused_launches_.clear();
  for (Stage& stage : stages_) unfused_launches_.push_back({&stage});
  fused_launches_ = unfused_launches_;
  for (const FusedProcesses& fused : table_.fused) {
    Stage *first = find(fused.first), *second = find(fused.second);
    if (!first || !second || !fused.applies(state_)) continue;
    const auto at = std::find_if(fused_launches_.begin(), fused_launches_.end(),
                                 [&](const Launch& launch) { return launch.stage == second; });
    *at = {first, second, &fused};
    fused_launches_.erase(
        std::find_if(fused_launches_.begin(), fused_launches_.end(),
                     [&](const Launch& launch) { return launch.stage == first && !launch.fused; }));
  }
  for (std::vector<Launch>* launches : {&unfused_launches_, &fused_launches_})
    for (Launch& launch : *launches)
      if (launch.stage->process->reads_heights || (launch.second && launch.second->process->reads_heights)) {
        launch.measures_heights = true;
        break;
      }
  leaves_heights_ = false;
  for (const Stage& stage : stages_) {
    if (stage.process->can_leave_heights) {
      leaves_heights_ = true;
      continue;
    }
    for (Layer layer : {Layer::bedrock, Layer::soil, Layer::sand, Layer::water})
      if (stage.process->may_write(layer)) leaves_heights_ = false;
  }
}

void Pipeline::adapt() {
  for (Stage& stage : stages_)
    if (stage.process->adapt) stage.process->adapt(state_, stage.workspace.get());
}

// ---- a step

StepContext Pipeline::context() { return {state_, fields_, state_.terrain.view(), leaves_heights_}; }

int Pipeline::parts() const {
  // What is longer is left to the processes' own sub-steps.
  constexpr auto most = static_cast<float>(max_parts_of_step);
  float longest = std::numeric_limits<float>::infinity();
  // No row of a wind series is passed over: each is the wind at the start of a part at least once.
  if (const auto& series = state_.scenario.wind_series)
    longest = static_cast<float>(series->shortest_interval());
  for (const Stage& stage : stages_) longest = std::min(longest, stage.process->longest_step(state_));
  return static_cast<int>(std::clamp(std::ceil(state_.scenario.run.time_step / longest), 1.0f, most));
}

Pipeline::PartClock Pipeline::next_part() {
  StepContext c = context();
  c.parts = parts();
  return {c.tick(), c.time_step(), c.wind_above()};
}

void Pipeline::step() {
  StepContext c = context();
  c.parts = parts();
  for (; c.part < c.parts; ++c.part) run_part(c);
  ++state_.steps;
  derived_ready_ = true;
}

void Pipeline::run_part(StepContext& c) {
  fields_.roll_dice(state_.exec(), state_.scenario.seed, c.tick());
  const bool observed = timing_ || checks_layers();
  if (observed) {
    for (const Launch& launch : unfused_launches_) run_observed(launch, c);
  } else {
    const std::size_t recorded = recordable_stages();
    const auto start = [&] {
      for (std::size_t n = 0; n < recorded; ++n) run(fused_launches_[n], c);
    };
    if (recorded > 0)
      recordings_.run(state_.exec(),
                      {c.wind_above(), fields_.heights_stale, c.renews_held_layers(), recorded,
                       recording_keys(c), c.terrain},
                      start);
    for (std::size_t n = recorded; n < fused_launches_.size(); ++n) run(fused_launches_[n], c);
  }
  if (c.renews_held_layers()) state_.held_layers_known = state_.has_held_layers();
  fields_.heights_stale = !leaves_heights_;
  for (Stage& stage : stages_)
    if (stage.process->after_step) stage.process->after_step(c, stage.workspace.get());
}

std::vector<std::uint64_t> Pipeline::recording_keys(const StepContext& c) const {
  std::vector<std::uint64_t> keys;
  for (const Stage& stage : stages_)
    if (stage.process->recording_key) keys.push_back(stage.process->recording_key(c));
  return keys;
}

std::size_t Pipeline::recordable_stages() const {
  if (!state_.exec().can_record()) return 0;
  const auto can = [this](const Stage* stage) { return !stage || stage->process->can_be_recorded(state_); };
  const auto end = std::find_if(fused_launches_.begin(), fused_launches_.end(), [&](const Launch& launch) {
    return !can(launch.stage) || !can(launch.second);
  });
  return static_cast<std::size_t>(end - fused_launches_.begin());
}

bool Pipeline::reads_heights() const {
  return std::any_of(stages_.begin(), stages_.end(),
                     [](const Stage& stage) { return stage.process->reads_heights; });
}

void Pipeline::measure_heights(StepContext& c) {
  if (!fields_.heights_stale) return;
  with_backend(c.exec(), [&](auto& e) { surface::compute_heights(e, c.terrain, fields_.heights); });
}

void Pipeline::run(const Launch& launch, StepContext& c) {
  if (launch.measures_heights) measure_heights(c);
  if (launch.fused)
    launch.fused->step(c, launch.stage->workspace.get(), launch.second->workspace.get());
  else
    launch.stage->process->step(c, launch.stage->workspace.get());
}

/// Looks through the layers that the process writes where that is due, and times it while timing is on.
void Pipeline::run_observed(const Launch& launch, StepContext& c) {
  Stage& stage = *launch.stage;
  const auto start = std::chrono::steady_clock::now();
  run(launch, c);
  if (checks_layers())
    for (const std::vector<Layer>* layers : {&stage.process->writes, &stage.process->writes_if_in_use})
      for (Layer layer : *layers) check(*stage.process, layer);
  if (!timing_) return;
  state_.exec().synchronise();
  const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
  stage.milliseconds += elapsed.count();
  stage.timed = true;
}

void Pipeline::step_alone(const std::string& process) {
  Stage* stage = find(process);
  if (!stage) throw Error("the process " + process + " is not active");
  StepContext c = context();
  fields_.roll_dice(state_.exec(), state_.scenario.seed, state_.steps);
  if (stage->process->reads_heights) measure_heights(c);
  stage->process->step(c, stage->workspace.get());
  state_.exec().synchronise();
}

void Pipeline::refresh_derived() {
  if (derived_ready_) return;
  StepContext c = context();
  if (reads_heights()) measure_heights(c);
  for (Stage& stage : stages_)
    if (stage.process->refresh) stage.process->refresh(c, stage.workspace.get());
  derived_ready_ = true;
}

bool Pipeline::checks_layers() const {
  const int every = state_.scenario.run.check_every;
  return every > 0 && (state_.steps + 1) % static_cast<std::uint64_t>(every) == 0;
}

/// Throws StateError, which names the process and the first cell, if the layer has a value that is not
/// finite, out of its scale, or negative where it must not be.
void Pipeline::check(const Process& process, Layer layer) const {
  if (!state_.terrain.has(layer)) return;
  const LayerInfo& row = info(layer);
  const TerrainView view = state_.terrain.view();
  const bool quanta = row.storage == Storage::quanta, depth = row.lowest == 0;
  const long long broken = with_backend(state_.exec(), [&](auto& e) {
    return statistics::count_violations(e, view.grid, quanta ? view.quanta(layer) : nullptr,
                                        quanta ? nullptr : view.real(layer), depth);
  });
  if (broken == 0) return;
  const std::vector<std::uint32_t> words = state_.terrain.raw_words(layer);
  const auto first = std::find_if(words.begin(), words.end(), [&](std::uint32_t word) {
    float real;
    std::memcpy(&real, &word, sizeof real);
    return quanta ? statistics::breaks_contract(static_cast<Quanta>(word), depth)
                  : statistics::breaks_contract(real);
  });
  const auto cell = static_cast<std::size_t>(first - words.begin());
  throw StateError("step " + std::to_string(state_.steps) + ": " + process.name + ": layer " + row.name +
                   " has an invalid value in " + std::to_string(broken) + " cells, the first at (" +
                   std::to_string(cell % view.grid.width) + ", " + std::to_string(cell / view.grid.width) +
                   ") = " + std::to_string(state_.terrain.values(layer)[cell]));
}

// ---- what others ask

Pipeline::Stage* Pipeline::find(const std::string& process) {
  const auto found = std::find_if(stages_.begin(), stages_.end(),
                                  [&](const Stage& stage) { return stage.process->name == process; });
  return found == stages_.end() ? nullptr : &*found;
}

std::uint64_t Pipeline::count(const std::string& counter) const {
  const auto before = state_.counts.find(counter);
  std::uint64_t counts = before == state_.counts.end() ? 0 : before->second;
  for (const Stage& stage : stages_)
    if (stage.process->counter == counter && stage.process->counted)
      counts += stage.process->counted(*stage.workspace);
  return counts;
}

double Pipeline::mean_count(const std::string& counter) const {
  return state_.steps ? static_cast<double>(count(counter)) / static_cast<double>(state_.steps) : 0.0;
}

std::map<std::string, std::string> Pipeline::warnings() const {
  std::map<std::string, std::string> all;
  for (const Stage& stage : stages_) {
    if (!stage.process->warning) continue;
    if (std::string text = stage.process->warning(state_, *stage.workspace); !text.empty())
      all[stage.process->name] = std::move(text);
  }
  return all;
}

bool Pipeline::writes(Layer layer) const {
  return std::any_of(stages_.begin(), stages_.end(), [layer](const Stage& stage) {
    return std::count(stage.process->writes.begin(), stage.process->writes.end(), layer) > 0;
  });
}

void Pipeline::edited(Layer layer) {
  for (const Process& process : table_.processes)
    if (process.edited) process.edited(state_, layer);
}

std::vector<ProcessTime> Pipeline::times() const {
  std::vector<ProcessTime> times;
  for (const Stage& stage : stages_)
    if (stage.timed) times.push_back({stage.process->name, stage.milliseconds});
  return times;
}

void Pipeline::clear_times() {
  for (Stage& stage : stages_) stage.milliseconds = 0, stage.timed = false;
}

std::vector<MemoryPart> Pipeline::memory() const {
  std::vector<MemoryPart> parts;
  const auto add = [&parts](const std::string& name, std::size_t bytes) {
    if (bytes > 0) parts.push_back({name, bytes});
  };
  for (const Stage& stage : stages_)
    if (stage.workspace) add("process " + stage.process->name, stage.workspace->bytes());
  add("heights", fields_.heights.cell_heights.bytes() + fields_.heights.highest.bytes());
  add("tangents of repose", fields_.repose.bytes());
  add("strength of impacts", fields_.impact_strength.bytes());
  add("scratch", fields_.second_scratch.bytes());
  add("sand before it moves", fields_.sand_before.bytes());
  add("dice", fields_.dice_keys.bytes());
  return parts;
}

std::vector<std::string> Pipeline::launch_names() const {
  std::vector<std::string> names;
  for (const Launch& launch : fused_launches_)
    names.push_back(launch.fused ? launch.fused->first + " + " + launch.fused->second
                                 : launch.stage->process->name);
  return names;
}

}  // namespace desert_sim
