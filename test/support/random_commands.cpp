#include "test/support/random_commands.hpp"

#include <cmath>
#include <limits>
#include <sstream>

#include "src/scenario/live_parameters.hpp"
#include "src/simulation/commands/edited_layers.hpp"

namespace desert_sim::test {

namespace {
constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                 infinity = std::numeric_limits<double>::infinity();
}

double RandomCommands::number(double lowest, double highest) {
  if (one_in(60)) {
    const double wrong[] = {
        nan, infinity, -infinity, lowest - 1, std::nextafter(highest, infinity), 2 * highest + 1};
    return wrong[below(std::size(wrong))];
  }
  switch (below(5)) {
    case 0:
      return lowest;
    case 1:
      return highest;
    case 2:
      return std::nextafter(highest, lowest);
    case 3:  // a small one, if there is any
      return std::min(std::max(std::ldexp(between(-1, 1), -static_cast<int>(below(40))), lowest), highest);
    default:
      return between(lowest, highest);
  }
}

template <class P>
void RandomCommands::randomise(P& parameters) {
  for_each_parameter(parameters, [&](const auto& row, auto& value) {
    using T = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<T, bool>) {
      value = one_in(2);
    } else if constexpr (std::is_enum_v<T>) {
      value = static_cast<T>(one_in(100) ? row.choice_count + 3 : static_cast<int>(below(row.choice_count)));
    } else if constexpr (std::is_same_v<T, std::uint64_t>) {
      value = one_in(2) ? std::numeric_limits<T>::max() - below(3) : static_cast<T>(random_()) << below(33);
    } else if constexpr (std::is_same_v<T, int>) {
      value = one_in(60) ? -1
                         : static_cast<int>(std::fmin(std::fmax(number(row.lowest, row.highest), row.lowest),
                                                      row.highest));
    } else if constexpr (std::is_floating_point_v<T>) {
      value = static_cast<T>(number(row.lowest, row.highest));
    }
  });
}

/// Near the terrain most of the time, and of a size that touches some of its cells.
template <class Edit>
void RandomCommands::place(Edit& edit, const Simulation& simulation) {
  if (one_in(8)) return;
  const GridParameters& grid = simulation.scenario().grid;
  edit.x = grid.origin_x + between(-0.2, 1.2) * grid.width * grid.cell_size;
  edit.y = grid.origin_y + between(-0.2, 1.2) * grid.height * grid.cell_size;
  edit.radius = between(0.001, 6) * grid.cell_size;
  edit.radius_y = between(0.001, 6) * grid.cell_size;
}

template <class Edit>
void RandomCommands::add_points(Edit& edit) {
  const bool polygon = edit.shape == BrushShape::polygon, capsule = edit.shape == BrushShape::capsule;
  if (!polygon && !capsule && !one_in(50)) return;
  const std::size_t count = capsule ? 2 : (one_in(20) ? 512 : 3 + below(5));
  for (std::size_t n = 0; n < count; ++n)
    edit.points.push_back({edit.x + between(-5, 5), one_in(200) ? nan : edit.y + between(-5, 5)});
}

command::SetWindSchedule RandomCommands::schedule() {
  command::SetWindSchedule command;
  command.stroke = stroke();
  WindRegime& regime = command.regime;
  randomise(static_cast<WindRegimeParameters&>(regime));
  if (one_in(20)) regime.start_time = nan;  // which is set when the command is applied
  regime.segments.resize(one_in(50) ? max_wind_segments : below(5));
  for (WindSegment& segment : regime.segments) {
    randomise(segment);
    if (!one_in(20)) segment.ramp = std::fmin(segment.ramp, segment.duration);
  }
  return command;
}

command::EditWind RandomCommands::wind_edit(const Simulation& simulation) {
  command::EditWind edit;
  randomise(edit);
  edit.stroke = stroke();
  randomise(edit.feature);
  if (!one_in(20)) edit.feature.begin = between(0, 20), edit.feature.end = one_in(2) ? 0 : between(20, 40);
  if (one_in(3)) {
    edit.feature.x = edit.feature.y = edit.feature.velocity_x = edit.feature.velocity_y = 0;
    double time = between(0, 20);
    for (int points = static_cast<int>(2 + below(3)); points > 0; --points, time += between(0.1, 9))
      edit.feature.path.push_back({time, between(-50, 150), between(-50, 150)});
  }
  const std::vector<WindFeature>& there = simulation.scenario().wind_features;
  if (edit.operation == WindEdit::add)
    edit.feature.id = static_cast<int>(1 + below(5));
  else if (!there.empty() && !one_in(4))
    edit.feature.id = there[below(there.size())].id;
  return edit;
}

/// One of a few names, none, or rarely one that is refused.
std::string RandomCommands::stroke() {
  const char* names[] = {"", "", "a", "b", "~", "null", "'\" : \\ #,{"};
  return one_in(60) ? "a\xff\n" : (one_in(60) ? std::string(256, 'x') : names[below(std::size(names))]);
}

command::EditTerrain RandomCommands::terrain_edit(const Simulation& simulation) {
  command::EditTerrain edit;
  randomise(static_cast<command::EditParameters&>(edit));
  const EditedLayer& row = edited_layers[below(std::size(edited_layers))];
  edit.layer = one_in(40) ? "du\xffst\n" : info(row.layer).name;
  edit.stroke = stroke();
  place(edit, simulation);
  add_points(edit);
  if (!one_in(4)) edit.value = between(0, row.kind == EditKind::material ? 3 : 1.2);
  if (edit.shape != BrushShape::patch) return edit;
  edit.patch.columns = static_cast<int>(1 + below(9));
  edit.patch.rows = static_cast<int>(1 + below(9));
  edit.patch.values.resize(static_cast<std::size_t>(edit.patch.columns) *
                           static_cast<std::size_t>(edit.patch.rows));
  for (float& value : edit.patch.values)
    value = static_cast<float>(edit.patch_use == PatchUse::mask ? between(0, 1) : between(0, 2));
  return edit;
}

command::EditPlants RandomCommands::plant_edit(const Simulation& simulation) {
  command::EditPlants edit;
  randomise(static_cast<command::EditPlantsParameters&>(edit));
  const std::vector<Species>& species = simulation.scenario().species;
  if (!species.empty() && !one_in(5)) edit.species = species[below(species.size())].name;
  edit.stroke = stroke();
  place(edit, simulation);
  add_points(edit);
  if (!one_in(4)) edit.density = between(0, 0.5);
  return edit;
}

/// Limits of memory and time are another matter: what makes a step of a small terrain last for seconds stays.
command::SetParameters RandomCommands::settings(const Simulation& simulation) {
  command::SetParameters command;
  command.stroke = stroke();
  Scenario wanted = simulation.state().present_scenario();
  const std::size_t count = 1 + below(3);
  for (std::size_t n = 0; n < count; ++n) {
    std::size_t all = 0;
    for_each_live_parameter(wanted, [&](const std::string&, const auto&, const auto&) { ++all; });
    std::size_t chosen = below(all);
    for_each_live_parameter(wanted, [&](const std::string& section, const auto& row, const auto& value) {
      using T = std::decay_t<decltype(value)>;
      if (chosen-- != 0) return;
      std::ostringstream text;
      text.precision(17);
      text << section << "." << row.name << "=";
      if constexpr (std::is_same_v<T, bool>)
        text << (one_in(2) ? "true" : "false");
      else if constexpr (std::is_same_v<T, Choice>)
        text << row.choices[below(row.choice_count)];
      else if constexpr (std::is_same_v<T, ShortList>)
        text << "[" << number(row.lowest, row.highest) << ", 3]";
      else if constexpr (std::is_same_v<T, std::uint64_t>)
        text << std::numeric_limits<T>::max() - below(3);
      else if constexpr (std::is_integral_v<T>)
        text << static_cast<long long>(between(row.lowest, std::min(row.highest, 60.0)));
      else if constexpr (std::is_arithmetic_v<T>)
        text << (std::string(row.name) == "time_step" ? between(-0.01, 3) : number(row.lowest, row.highest));
      command.settings.push_back(text.str());
    });
  }
  if (const std::size_t kinds = wanted.species.size(); kinds > 0 && one_in(6)) {
    const std::string at = "species." + std::to_string(below(kinds));
    const char* const changes[] = {".max_radius=0.7", ".spawn=3", ".name=\"other\"", ".stem=-1", "=[]"};
    command.settings.push_back(at + changes[below(std::size(changes))]);
  }
  if (one_in(12) && wanted.species.size() < 4)
    command.settings.push_back("species." + std::to_string(wanted.species.size()) +
                               "={preset: palm, name: palm_" + std::to_string(wanted.species.size()) + "}");
  if (one_in(10)) command.settings.push_back("water.springs=[{x: 3, y: 4, discharge: 1e5}]  # \xff\t\n");
  command.ramp =
      one_in(2) ? 0 : (one_in(2) ? between(0, 20) : number(0, command::SetParameters::longest_ramp));
  return command;
}

Command RandomCommands::next(const Simulation& simulation, const std::vector<std::string>& checkpoints,
                             const std::vector<std::string>& scenarios) {
  switch (below(20)) {
    case 0: {
      command::SetWind wind;
      randomise(wind);
      wind.stroke = stroke();
      return wind;
    }
    case 1:
    case 2:
      return schedule();
    case 3:
    case 4:
      return wind_edit(simulation);
    case 5:
    case 6:
    case 7:
      return plant_edit(simulation);
    case 8:
    case 9:
    case 10:
      return settings(simulation);
    case 11:
      if (one_in(3)) return command::Reset{};
      if (!checkpoints.empty()) return command::LoadCheckpoint{checkpoints[below(checkpoints.size())]};
      break;
    case 12:
      if (!scenarios.empty() && one_in(2))
        return command::LoadScenario{scenarios[below(scenarios.size())], one_in(2), 0, one_in(2)};
      break;
    case 13:
    case 14:
      return command::Undo{stroke()};
    case 15:
      return command::Redo{stroke()};
    default:
      break;
  }
  return terrain_edit(simulation);
}

}  // namespace desert_sim::test
