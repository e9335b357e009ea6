#include "src/simulation/processes/settings_without_effect.hpp"

#include <yaml-cpp/yaml.h>

#include <set>

#include "kernels/sand/saltation.hpp"
#include "kernels/water/water_parameters.hpp"
#include "src/core/number_text.hpp"
#include "src/scenario/yaml_parameters.hpp"
#include "src/simulation/pipeline/pipeline.hpp"
#include "src/simulation/processes/processes.hpp"

namespace desert_sim {

namespace {

/// Names of the sections that processes read: of all, or of those that take part in a scenario.
std::set<std::string> sections_read(const Scenario* scenario = nullptr) {
  const ProcessTable& table = process_table();
  std::set<std::string> sections;
  for (const Process& process : table.processes)
    if (!scenario || table.is_active(process, *scenario))
      sections.insert(process.parameters.begin(), process.parameters.end());
  return sections;
}

bool is_switched_off(const YAML::Node& part) {
  return part.IsMap() && part["enabled"].IsDefined() && !part["enabled"].as<bool>();
}

}  // namespace

std::vector<std::string> settings_without_effect(const Scenario& scenario) {
  std::vector<std::string> lines;
  const YAML::Node given = YAML::Load(dump_scenario(scenario)), usual = YAML::Load(dump_scenario(Scenario()));
  const std::set<std::string> read = sections_read(&scenario);
  for (const std::string& name : sections_read())
    if (name != "wind" && !read.count(name) && YAML::Dump(given[name]) != YAML::Dump(usual[name]) &&
        !is_switched_off(given[name]))
      lines.push_back(name + ": has no effect: no process that takes part in this scenario reads it");
  if (!scenario.wind_segments.empty() && scenario.wind_regime.regime == WindRegimeKind::constant)
    lines.emplace_back("wind.segments: have no effect, because wind.regime is constant");
  if (scenario.get<SaltationParameters>().influx > 0 && scenario.grid.boundary == Boundary::periodic)
    lines.emplace_back("saltation.influx: has no effect, because grid.boundary is periodic");
  for (std::size_t n = 0; n < scenario.timeline.size(); ++n)
    if (const double every = scenario.timeline[n].every;
        every > 0 && static_cast<float>(every) < scenario.run.time_step)
      lines.push_back("run.timeline." + std::to_string(n) + ".every: " + number_text(every, 9) +
                      " s is shorter than a step of " +
                      number_text(static_cast<double>(scenario.run.time_step), 6) +
                      " s, so that it happens once a step");
  if (scenario.get<WaterParameters>().sea != Sea::none && !has_water(scenario))
    lines.emplace_back("water.sea: has no effect, because the scenario has no water (water.enabled)");
  return lines;
}

}  // namespace desert_sim
