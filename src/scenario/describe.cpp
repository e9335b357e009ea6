/// The page of all parameters, from the tables.
#include <sstream>

#include "desert_sim/kernels/layers.hpp"
#include "desert_sim/scenario/live_parameters.hpp"
#include "desert_sim/simulation/wind_regime.hpp"

namespace desert_sim {

namespace {

template <class P>
void rows(std::ostringstream& out, const P& defaults) {
  out << "| key | default | unit | allowed | what |\n|---|---|---|---|---|\n";
  for_each_parameter(defaults, [&](const auto& row, const auto& value) {
    using T = std::decay_t<decltype(value)>;
    out << "| `" << row.name << "` | ";
    std::ostringstream allowed;
    if constexpr (std::is_enum_v<T>) {
      out << row.choices[static_cast<int>(value)];
      for (int n = 0; n < row.choice_count; ++n) allowed << (n ? ", " : "") << row.choices[n];
    } else if constexpr (std::is_same_v<T, ShortList>) {
      out << "[";
      for (int n = 0; n < value.count; ++n) out << (n ? ", " : "") << value.values[n];
      out << "]";
      allowed << "up to " << ShortList::capacity << " of " << row.lowest << " … " << row.highest;
    } else if constexpr (std::is_same_v<T, bool>) {
      out << (value ? "true" : "false");
      allowed << "true, false";
    } else if constexpr (std::is_same_v<T, std::string>) {
      out << (value.empty() ? "" : "`" + value + "`");
      allowed << "text";
    } else {
      out << value;
      allowed << row.lowest << " … " << row.highest;
    }
    out << " | " << row.unit << " | " << allowed.str() << " | " << row.doc << " |\n";
  });
}

template <std::size_t N = 0>
void terrain_steps(std::ostringstream& out) {
  if constexpr (N < std::variant_size_v<TerrainStep>) {
    out << "\n### `" << terrain_step_names[N] << "`\n\n";
    rows(out, std::variant_alternative_t<N, TerrainStep>());
    terrain_steps<N + 1>(out);
  }
}

}  // namespace

std::string describe_parameters() {
  std::ostringstream out;
  out << "# Parameters of a scenario\n\n"
         "Written by `desert_run --describe`; a test fails when it is stale. The same keys are read from "
         "scenario "
         "files, from `--set path=value`, and from ROS parameters. 0 in `grid` stands for \"not given\".\n\n"
         "## top level\n\n";
  rows(out, SeedParameter());
  Scenario defaults;
  for_each_section(defaults, [&](const char* section, const auto& parameters) {
    out << "\n## `" << section << "`\n\n";
    rows(out, parameters);
  });
  out << "\n## `wind`\n\n### high above the ground\n\n";
  rows(out, WindRegimeParameters());
  out << "\n### each of `wind.segments`\n\n";
  rows(out, WindSegment());
  out << "\n### at the surface\n\n";
  rows(out, WindParameters());
  out << "\n### each of `wind.features`\n\n";
  rows(out, WindFeature());
  out << "\n## `terrain`: a list of steps, in order\n";
  terrain_steps(out);
  out << "\n## What cannot change while a simulation runs\n\n";
  for (const FixedParameter& fixed : fixed_parameters)
    out << "- `" << fixed.path << "`: " << fixed.why << ".\n";
  out << "\nAll else can: `dynamic_reconfigure`, `~reload_parameters`.\n";
  constexpr const char* kinds[] = {"persistent", "derived", "on request"};
  out << "\n## Layers\n\n| layer | unit | kind | what |\n|---|---|---|---|\n";
  for (const LayerInfo& layer : layer_table)
    out << "| `" << layer.name << "` | " << layer.unit << " | " << kinds[static_cast<int>(layer.lifetime)]
        << " | " << layer.doc << " |\n";
  return out.str();
}

}  // namespace desert_sim
