#include "src/simulation/forecast/forecast.hpp"

#include <cstdio>

#include "src/core/error.hpp"
#include "src/scenario/range_checks.hpp"
#include "src/simulation/checkpoint.hpp"
#include "src/simulation/forecast/forecast_clock.hpp"
#include "src/simulation/forecast/passability.hpp"
#include "src/simulation/memory/memory.hpp"

namespace desert_sim {

ForecastRun::ForecastRun(std::string checkpoint, const ForecastOptions& options, const std::string& backend,
                         int threads)
    : options_(options),
      checkpoint_(std::move(checkpoint)),
      exec_(make_exec(backend, threads, nullptr, Precedence::last)) {
  check_ranges(static_cast<const ForecastParameters&>(options_), "forecast");
  check_ranges(options_.gusts, "forecast");
  simulation_ = member(0);
  require_steps();
  if (options_.members == 1) checkpoint_ = {};
}

std::unique_ptr<Simulation> ForecastRun::member(int number) const {
  std::unique_ptr<Simulation> simulation = simulation_from_bytes(checkpoint_, *exec_, "forecast");
  for (const ForecastCommand& command : options_.commands)
    std::visit([&](const auto& c) { simulation->apply(c); }, command);
  lengthen_steps(*simulation);
  if (number == 0) return simulation;
  Gusts gusts{options_.gusts};
  gusts.member = static_cast<std::uint32_t>(number);
  gusts.start_time = simulation->time();
  simulation->state().gusts = gusts;
  return simulation;
}

/// Makes the present time step that of `stride` steps.
void ForecastRun::lengthen_steps(Simulation& simulation) const {
  if (options_.stride == 1) return;
  char setting[60];
  std::snprintf(setting, sizeof setting, "run.time_step=%.9g",
                static_cast<double>(simulation.scenario().run.time_step) * options_.stride);
  simulation.apply(command::SetParameters{{setting}});
}

/// Throws ConfigError if the horizon has too many steps, or none.
void ForecastRun::require_steps() const {
  const double interval = ForecastClock(step_rate()).interval(simulation_->scenario().run),
               most = static_cast<double>(ForecastOptions::most_steps) * interval;
  if (options_.horizon >= interval && options_.horizon <= most) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "forecast: horizon: %g s has %.0f steps of %g s (allowed: %g s to %g s, which is 1 to %llu "
                "steps)",
                options_.horizon, options_.horizon / interval, interval, interval, most,
                static_cast<unsigned long long>(ForecastOptions::most_steps));
  throw ConfigError(text);
}

/// False if `progress` ended it.
bool ForecastRun::step_to_horizon(int number, const Progress& progress, const Visit& visit) {
  ForecastClock clock(step_rate());
  const RunParameters& run = simulation_->scenario().run;
  float time_step = run.time_step;
  std::uint64_t steps = 0;
  for (int n = 1; n <= options_.moments; ++n) {
    const double time = options_.horizon * n / options_.moments;
    while (clock.due(run, time)) {
      if (!progress(number, clock.time())) return false;
      if (++steps > ForecastOptions::most_steps)
        throw ConfigError("forecast: horizon: the timeline needs more than " +
                          std::to_string(ForecastOptions::most_steps) + " steps up to it");
      clock.step(run);
      simulation_->step();
      if (run.time_step == time_step) continue;
      lengthen_steps(*simulation_);  // a timeline has set another one in this step
      time_step = run.time_step;
    }
    visit(static_cast<std::size_t>(n - 1), time);
  }
  return true;
}

std::vector<float> ForecastRun::elevation() {
  return simulation_->views().snapshot({Layer::elevation})->layers.at(Layer::elevation);
}

const std::vector<std::int8_t>& ForecastRun::costs() {
  const Grid& grid = simulation_->terrain().grid();
  CostQuery query;
  query.whole = true;  // that is, each tile in which a cost has changed since the last query
  costs_.resize(static_cast<std::size_t>(grid.cells()), cell_cost::unknown);
  simulation_->views().begin_costs(query).whole.get()->write_to(costs_, grid.width);
  return costs_;
}

std::optional<ForecastMaps> ForecastRun::run(const Progress& progress) {
  const GridParameters& grid = simulation_->scenario().grid;
  const RunParameters& run = simulation_->scenario().run;
  ForecastMaps forecast;
  forecast.step = simulation_->steps();
  forecast.sim_time = simulation_->time();
  forecast.seconds_per_sim_second = ForecastClock(step_rate()).interval(run) / run.time_step;
  forecast.members = options_.members;
  forecast.width = grid.width;
  forecast.height = grid.height;
  forecast.cell_size = grid.cell_size;
  forecast.origin_x = grid.origin_x;
  forecast.origin_y = grid.origin_y;
  forecast.moments.resize(static_cast<std::size_t>(options_.moments));

  const auto count_passable = [&](ForecastMoment& moment, const std::vector<std::int8_t>& costs) {
    if (options_.members == 1) return;
    moment.probability.resize(costs.size());
    for (std::size_t i = 0; i < costs.size(); ++i)
      moment.probability[i] += is_passable(costs[i]) ? 1.0F : 0.0F;
  };
  Passability passability(costs());
  if (!step_to_horizon(0, progress, [&](std::size_t n, double time) {
        ForecastMoment& moment = forecast.moments[n];
        moment.time = time;
        moment.step = simulation_->steps();
        moment.sim_time = simulation_->time();
        moment.hash = simulation_->state().hash();
        moment.elevation = elevation();
        moment.costs = costs();
        passability.add(time, moment.costs);
        count_passable(moment, moment.costs);
      }))
    return {};
  forecast.passable_until = passability.until();
  forecast.passable_from = passability.from();
  for (int number = 1; number < options_.members; ++number) {
    simulation_.reset();  // before the next takes its memory
    simulation_ = member(number);
    if (!step_to_horizon(number, progress,
                         [&](std::size_t n, double) { count_passable(forecast.moments[n], costs()); }))
      return {};
  }
  for (ForecastMoment& moment : forecast.moments)
    for (float& share : moment.probability) share /= static_cast<float>(options_.members);
  return forecast;
}

ForecastMemory memory_for_forecast(const Simulation& simulation, const ForecastParameters& options) {
  const auto cells = static_cast<double>(simulation.terrain().grid().cells());
  const double elevation = sizeof(float), cost = sizeof(std::int8_t), share = sizeof(float);
  // What the copy looks at itself with: the elevation, held costs, and the way of both to the host.
  const double on_device =
      static_cast<double>(total_bytes(simulation.memory())) + cells * (elevation + 2 * cost + 2 * elevation);
  const double moment = elevation + cost + (options.members > 1 ? share : 0.0),
               maps = options.moments * moment + 2 * share;
  const double checkpoint = static_cast<double>(simulation.terrain().bytes()) +
                            static_cast<double>(simulation.state().plants.bytes());
  return {on_device, checkpoint + 3 * maps * cells};
}

void require_memory_for_forecast(const Simulation& simulation, const ForecastParameters& options) {
  const ForecastMemory memory = memory_for_forecast(simulation, options);
  require_bytes(simulation.exec(), simulation.scenario(), memory.on_device, memory.on_host,
                "for a forecast of " + std::to_string(options.moments) + " moments");
}

}  // namespace desert_sim
