/// Commands that a simulation carries out between steps.
#include <cmath>

#include "desert_sim/core/error.hpp"
#include "desert_sim/scenario/live_parameters.hpp"
#include "desert_sim/scenario/yaml_parameters.hpp"
#include "desert_sim/simulation/simulation.hpp"

namespace desert_sim {

namespace {

/// Every number in its row's range: commands come from services, whose fields can hold anything.
template <class P>
void check_ranges(const P& parameters, const std::string& what) {
  Faults faults(what);
  for_each_parameter(parameters, [&](const auto& row, const auto& value) {
    using T = std::decay_t<decltype(value)>;
    if constexpr (std::is_enum_v<T>) {
      if (static_cast<int>(value) < 0 || static_cast<int>(value) >= row.choice_count)
        faults.add(row.name, std::to_string(static_cast<int>(value)) + " is none of its choices");
    } else if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) {
      const double number = static_cast<double>(value);
      if (!yaml::in_range<T>(number, row)) {
        std::ostringstream shown;
        shown << "= " << number << " is not in " << yaml::allowed_range(row);
        faults.add(row.name, shown.str());
      }
    }
  });
  faults.throw_if_any();
}

}  // namespace

void Simulation::set_regime(WindRegime regime) {
  regime.from = wind_above();
  regime.start_time = time();
  regime_ = std::move(regime);
}

Scenario Simulation::present_scenario() const {
  Scenario scenario = scenario_;
  scenario.wind_regime = regime_;
  scenario.wind_segments = regime_.segments;
  return scenario;
}

CommandResult Simulation::apply(const command::SetParameters& command) {
  const Scenario before = scenario_, present = present_scenario(),
                 changed = with_live_settings(present, command.settings);
  require_reach(changed);
  exec().synchronise();  // memory that steps in flight work with is given back
  scenario_ = changed;
  try {
    prepare_processes();
  } catch (...) {
    scenario_ = before;
    prepare_processes();
    throw;
  }
  derived_ready_ = false;
  const auto regime = [](const Scenario& s) {
    YAML::Emitter out;
    yaml::keep_all_bits(out);
    out << YAML::BeginMap;
    yaml::emit_parameters(out, s.wind_regime);
    return std::string(out.c_str());
  };
  if (regime(changed) != regime(present)) set_regime({changed.wind_regime, changed.wind_segments});
  return {};
}

CommandResult Simulation::apply(const command::SetWind& command) {
  check_ranges(command, "set_wind");
  WindRegime regime;
  regime.direction_deg = command.direction_deg;
  regime.speed = command.speed;
  regime.ramp = command.ramp;
  set_regime(regime);
  return {};
}

CommandResult Simulation::apply(const command::SetWindSchedule& command) {
  const WindRegime& r = command.regime;
  Faults faults("set_wind_schedule");
  if (r.regime == WindRegimeKind::constant) faults.add("kind", "must be timeline or rose");
  if (r.segments.empty()) faults.add("segments", "there must be at least one");
  if (!(r.hold_time >= 1e-3f && r.hold_time <= 1e12f))
    faults.add("hold_time", "= " + std::to_string(r.hold_time) + " is not in [0.001, 1e+12] s");
  double probability = 0;
  for (std::size_t n = 0; n < r.segments.size(); ++n) {
    check_ranges(r.segments[n], "set_wind_schedule: segment " + std::to_string(n));
    if (r.segments[n].ramp > r.segments[n].duration)
      faults.add("segment " + std::to_string(n) + ": ramp", "is longer than the segment's duration");
    probability += r.segments[n].probability;
  }
  if (r.regime == WindRegimeKind::rose && !(probability > 0))
    faults.add("segments", "the probabilities must not all be 0");
  faults.throw_if_any();
  set_regime(r);
  return {};
}

brush::Brush Simulation::prepare(const command::EditTerrain& c, CellRectangle& touched) const {
  const GridParameters& g = scenario_.grid;
  const bool sand = c.layer == "sand";
  const double l = g.cell_size, per_metre = 1.0 / terrain_.scale().quantum();
  const double radius_y = c.shape == BrushShape::circle ? c.radius : c.radius_y;
  const wind::Vector axis = c.shape == BrushShape::circle ? wind::Vector{1, 0} : unit_vector(c.angle_deg);
  // Half extents of the (turned) ellipse along the grid's axes.
  const double reach_x = std::hypot(c.radius * axis.x, radius_y * axis.y) / l;
  const double reach_y = std::hypot(c.radius * axis.y, radius_y * axis.x) / l;
  const double x = (c.x - g.origin_x) / l, y = (c.y - g.origin_y) / l;

  const TerrainView view = terrain_.view();
  brush::Brush b{};
  b.grid = view.grid;
  const auto span = [](double centre, double reach, int n, bool periodic, int& first, int& count) {
    double low = std::floor(centre - reach), high = std::ceil(centre + reach);
    if (periodic && high - low > n) low = std::floor(centre - 0.5 * n), high = low + n;
    if (!periodic) low = std::max(low, 0.0), high = std::min(high, static_cast<double>(n));
    first = high > low ? static_cast<int>(low) : 0;
    count = high > low ? static_cast<int>(high - low) : 0;
  };
  // Bring the centre of a periodic grid's brush onto the grid, so that single precision places it.
  const double cx = b.grid.periodic_x ? x - g.width * std::floor(x / g.width) : x;
  const double cy = b.grid.periodic_y ? y - g.height * std::floor(y / g.height) : y;
  span(cx, reach_x, g.width, b.grid.periodic_x, b.x0, b.columns);
  span(cy, reach_y, g.height, b.grid.periodic_y, b.y0, b.rows);
  b.centre_x = static_cast<float>(cx);
  b.centre_y = static_cast<float>(cy);
  b.radius_x = static_cast<float>(c.radius / l);
  b.radius_y = static_cast<float>(radius_y / l);
  b.cos = axis.x;
  b.sin = axis.y;
  b.inner = static_cast<float>(c.inner);
  b.merge = c.merge;
  const bool change = c.merge == BrushMerge::add || c.merge == BrushMerge::sub;
  b.value = (c.value - (sand || change ? 0.0 : terrain_.scale().datum)) * per_metre;
  b.depth = sand;
  b.material = sand ? Material::sand : Material::bedrock;
  b.layer = view.quanta(sand ? Layer::sand : Layer::bedrock);
  b.rest[0] = view.quanta(sand ? Layer::bedrock : Layer::sand);
  b.rest[1] = view.quanta(Layer::soil);
  b.ledger = ledger();
  touched = {b.x0, b.y0, b.x0 + b.columns, b.y0 + b.rows};
  // Over a periodic border the rectangle that holds both parts is the whole axis.
  if (b.x0 < 0 || touched.x1 > g.width) touched.x0 = 0, touched.x1 = g.width;
  if (b.y0 < 0 || touched.y1 > g.height) touched.y0 = 0, touched.y1 = g.height;
  return b;
}

CommandResult Simulation::apply(const command::EditTerrain& command) {
  check_ranges(command, "edit_terrain");
  if (command.layer != "sand" && command.layer != "bedrock")
    throw ConfigError("edit_terrain: layer: '" + command.layer + "' is not one of: sand, bedrock");
  if (command.layer == "sand" && command.value < 0)
    throw ConfigError("edit_terrain: value: = " + std::to_string(command.value) +
                      " is not a depth of sand (allowed: [0, 100000] m)");
  CommandResult result;
  const brush::Brush b = prepare(command, result.touched);
  if (b.columns == 0 || b.rows == 0)
    throw ConfigError("edit_terrain: the brush at (" + std::to_string(command.x) + ", " +
                      std::to_string(command.y) + ") touches no cell of the terrain");
  const long long beyond = with_backend(exec(), [&](auto& e) { return brush::cells_beyond_limit(e, b); });
  if (beyond > 0) {
    const double reach = static_cast<double>(load_limit) * terrain_.scale().quantum(),
                 datum = terrain_.scale().datum;
    throw ConfigError("edit_terrain: value: = " + std::to_string(command.value) + " would bring " +
                      std::to_string(beyond) + " cells out of this terrain's heights (allowed: [" +
                      std::to_string(datum - reach) + ", " + std::to_string(datum + reach) + "] m)");
  }
  if (b.material == Material::bedrock) prepare_ground_avalanches();
  const std::vector<long long> before = read_ledger();
  with_backend(exec(), [&](auto& e) { brush::apply(e, b); });
  const std::vector<long long> after = read_ledger();
  const std::size_t account = 2 * static_cast<std::size_t>(b.material);
  const double quantum_volume =
      terrain_.scale().quantum() * scenario_.grid.cell_size * scenario_.grid.cell_size;
  result.volume_m3 =
      static_cast<double>((after[account] - before[account]) - (after[account + 1] - before[account + 1])) *
      quantum_volume;
  if (b.material == Material::bedrock) bedrock_loose_ = true;
  return result;
}

}  // namespace desert_sim
