/// Planners and forecasts in the certificate.
#include <algorithm>

#include "src/core/error.hpp"
#include "src/planner/field_planner.hpp"
#include "src/planner/heading_costs.hpp"
#include "src/planner/timed_planner.hpp"
#include "src/simulation/checkpoint.hpp"
#include "src/simulation/forecast/forecast.hpp"
#include "src/simulation/forecast/forecast_clock.hpp"
#include "src/simulation/forecast/passability.hpp"
#include "src/simulation/session.hpp"
#include "src/tools/certified_hash.hpp"
#include "src/tools/digest.hpp"

namespace desert_sim {

namespace {

constexpr double speed = 0.5;     // of the rover whose way through a forecast is planned [m/s]
constexpr double spacing = 0.25;  // of a path's points [m]
constexpr int later = 10;         // steps after which the field is repaired
constexpr CostParameters rover{16, 8, 0, 0.5};

ForecastMaps forecast(Simulation& from, const CertifiedPlace& place, std::uint64_t steps, int members) {
  ForecastOptions options;
  const RunParameters& run = from.scenario().run;
  options.horizon = static_cast<double>(steps) * ForecastClock(0).interval(run);
  options.moments = 4;
  options.members = members;
  options.gusts.gust_speed = 0.2;
  options.gusts.gust_direction_deg = 20;
  options.gusts.gust_time = 10 * static_cast<double>(run.time_step);
  ForecastRun ahead(checkpoint_bytes(from), options, place.backend, place.threads);
  return *ahead.run([](int, double) { return true; });
}

std::shared_ptr<const Snapshot> look(Session& session) {
  return session.simulation().views().snapshot({Layer::traversability, Layer::elevation, Layer::slip,
                                                Layer::slip_downhill, Layer::slip_across, Layer::sinkage,
                                                Layer::wind_x, Layer::wind_y});
}

HeadingLayers heading_layers(const Snapshot& s) {
  const auto values = [&s](Layer layer) {
    const std::vector<float>* found = s.find(layer);
    return found ? *found : std::vector<float>();
  };
  HeadingLayers layers;
  layers.elevation = values(Layer::elevation);
  layers.slip = values(Layer::slip);
  layers.slip_downhill = values(Layer::slip_downhill);
  layers.slip_across = values(Layer::slip_across);
  layers.sinkage = values(Layer::sinkage);
  layers.wind_x = values(Layer::wind_x);
  layers.wind_y = values(Layer::wind_y);
  return layers;
}

std::vector<CellIndex> update(CostGrid& grid, const Snapshot& s) {
  std::vector<CellIndex> changed;
  grid.update({0, 0, s.width, s.height}, s.find(Layer::traversability)->data(), changed);
  return changed;
}

/// The passable cell nearest to a point at these shares of the grid.
CellIndex place_at(const CertifiedRun& run, const CostGrid& grid, double east, double north) {
  const GridFrame& f = grid.frame();
  const double width = f.width * f.cell_size, height = f.height * f.cell_size;
  const auto cell = grid.nearest_passable({f.origin_x + east * width, f.origin_y + north * height},
                                          std::max(width, height));
  if (!cell) throw ConfigError("certificate: run " + run.name + ": no ground is passable");
  return *cell;
}

void add(Digest& digest, const GridPath& path) {
  for (const GridPoint& p : path) digest.add(p.x), digest.add(p.y);
}

void add(Digest& digest, const std::optional<double>& cost) { digest.add(cost.value_or(-1)); }

void add_paths(Digest& digest, const std::shared_ptr<const CostGrid>& grid, const FieldPlanner& field,
               CellIndex start, const Snapshot& s) {
  digest.add(grid->costs());
  digest.add(field.values());
  const std::vector<CellIndex> cells = field.path_from(start);
  if (cells.empty()) return;
  const GridPath path = shortened(*grid, cells);
  add(digest, path);
  add(digest, resampled(path, spacing));
  digest.add(path_length(path));
  add(digest, path_cost(*grid, path));
  add(digest, HeadingCosts(grid, heading_layers(s), {}).path(path));
}

/// The costs at the start and at the moments of a forecast, in which a cost of 99 is barely passable.
TimedCosts timed_costs(const CostGrid& now, const ForecastMaps& maps) {
  TimedCosts costs{{0}, {std::make_shared<CostGrid>(now)}};
  for (const ForecastMoment& moment : maps.moments) {
    std::vector<float> traversability;
    for (const std::int8_t cost : moment.costs)
      traversability.push_back(is_passable(cost) ? std::max(1 - static_cast<float>(cost) / 99, 0.001F) : 0);
    auto grid = std::make_shared<CostGrid>(now.frame(), rover);
    std::vector<CellIndex> changed;
    grid->update({0, 0, maps.width, maps.height}, traversability.data(), changed);
    costs.times.push_back(moment.time);
    costs.grids.push_back(std::move(grid));
  }
  return costs;
}

void add(Digest& digest, const std::vector<TimedPoint>& path) {
  for (const TimedPoint& p : path)
    for (const double value : {p.point.x, p.point.y, p.arrival, p.departure}) digest.add(value);
}

}  // namespace

std::uint64_t planner_hash(const CertifiedRun& run, const CertifiedPlace& place) {
  Session session(certified_scenario(run), place.load_raster, place.backend, place.threads);
  for (std::uint64_t n = 0; n < run.steps; ++n) session.step();
  const ForecastMaps maps = forecast(session.simulation(), place, run.steps, 1);
  std::shared_ptr<const Snapshot> s = look(session);
  const auto grid = std::make_shared<CostGrid>(
      GridFrame{s->width, s->height, s->cell_size, s->origin_x, s->origin_y}, rover);
  update(*grid, *s);
  const CellIndex start = place_at(run, *grid, 0.15, 0.3), goal = place_at(run, *grid, 0.85, 0.7);
  Digest digest;
  TimedPlanner timed(timed_costs(*grid, maps), {speed, 2});
  add(digest, timed.plan(start, goal));
  add(digest, timed.shelter());
  FieldPlanner field(*grid);
  field.compute(goal);
  add_paths(digest, grid, field, start, *s);
  for (int n = 0; n < later; ++n) session.step();
  s = look(session);
  field.note(update(*grid, *s));
  field.repair({});
  add_paths(digest, grid, field, start, *s);
  return digest.value();
}

std::uint64_t forecast_hash(const CertifiedRun& run, const CertifiedPlace& place) {
  Session session(certified_scenario(run), place.load_raster, place.backend, place.threads);
  const ForecastMaps maps = forecast(session.simulation(), place, run.steps, 3);
  Digest digest;
  for (const ForecastMoment& moment : maps.moments) {
    digest.add(moment.time), digest.add(moment.step), digest.add(moment.hash), digest.add(moment.sim_time);
    digest.add(moment.elevation), digest.add(moment.costs), digest.add(moment.probability);
  }
  digest.add(maps.passable_until), digest.add(maps.passable_from);
  return digest.value();
}

}  // namespace desert_sim
