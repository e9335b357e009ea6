/// Writes config/parameters.md, the page of all parameters, from the parameter tables.
#include <sstream>

#include "kernels/field/layers.hpp"
#include "src/core/parameter_page.hpp"
#include "src/scenario/climate.hpp"
#include "src/scenario/live_parameters.hpp"
#include "src/scenario/rover_presets.hpp"
#include "src/scenario/seed_parameter.hpp"
#include "src/scenario/wind_regime.hpp"

namespace desert_sim {

namespace {

template <std::size_t N = 0>
void terrain_steps(std::ostringstream& out) {
  if constexpr (N < std::variant_size_v<TerrainStep>) {
    out << "\n### `" << terrain_step_names[N] << "`\n\n";
    write_parameter_table(out, std::variant_alternative_t<N, TerrainStep>());
    terrain_steps<N + 1>(out);
  }
}

}  // namespace

std::string describe_parameters() {
  std::ostringstream out;
  out << "# Parameters of a scenario\n\n"
         "Written by `desert_run --describe`; a test fails when it is stale. The same keys are read from "
         "scenario files, from `--set path=value`, and from ROS parameters; those of the node itself are in "
         "[node_parameters.md](node_parameters.md). 0 in `grid` stands for \"not given\". A parameter in s "
         "may be "
         "given with a unit: `1 h` (ms, s, min, h, d, or a, which is 365.25 d).\n\n"
         "## top level\n\n";
  write_parameter_table(out, SeedParameter());
  out << "\n`climate`, if given, sets rain, evaporation, soil and species together; what the scenario says "
         "of them "
         "overrides it (config/climates):\n\n";
  for (const std::string& name : climates()) out << "- `" << name << "`: " << climate_doc(name) << "\n";
  out << "\n`rover`, if given, sets the section `traversability`; what the scenario says of it overrides it "
         "(config/rovers):\n\n";
  for (const std::string& name : rover_presets())
    out << "- `" << name << "`: " << rover_preset_doc(name) << "\n";
  out << "\n## `grid`\n\n";
  write_parameter_table(out, GridParameters());
  const Sections defaults;
  for (const Section* section : defaults.all()) section->describe(out);
  out << "\n## `wind`\n\n### high above the ground\n\n";
  write_parameter_table(out, WindRegimeParameters());
  out << "\n### each of `wind.segments`\n\n";
  write_parameter_table(out, WindSegment());
  out << "\n### at the surface\n\n";
  write_parameter_table(out, WindParameters());
  out << "\n### each of `wind.features`\n\n";
  write_parameter_table(out, WindFeatureParameters());
  out << "\n### each of `wind.features.path`, in the place of `x`, `y` and the velocity\n\n";
  write_parameter_table(out, WindPathPoint());
  out << "\n## `run`\n\n";
  write_parameter_table(out, RunParameters());
  out << "\n### each of `run.timeline`\n\n"
         "`{time: [s], ramp: [s], set: {path: value, ...}}`: at `time`, the parameters at the paths (any "
         "that can "
         "change while a simulation runs, such as `rain.rate`) change to the values; numbers over `ramp` "
         "seconds "
         "(0 if not given), all else at once.\n\n"
         "`{time: [s], command: NAME, ...}` with the keys of the command, as a journal has them: at `time`, "
         "`set_wind`, "
         "`set_wind_schedule`, `edit_wind`, `edit_terrain` or `edit_plants` is applied as the service of "
         "that "
         "name "
         "would. What is refused when it is due is an error in the log, and the run goes on. `edit_terrain` "
         "with `shape: patch` takes a raster, relative to the scenario's folder: `image_file`, with "
         "`image_scale` for heights.\n\n"
         "Both may have `every: [s]`, from time step to time step at most, and `until: [s]`: they happen "
         "again and "
         "again. `desert_run --script FILE` adds a list of such entries from a file.\n";
  out << "\n## `species`: a list of at most " << max_species << "\n\n";
  write_parameter_table(out, SpeciesName());
  out << "\nPresets:";
  for (const std::string& preset : species_presets()) out << " `" << preset << "`";
  out << " (config/species).\n\n";
  write_parameter_table(out, SpeciesTraits());
  out << "\n";
  write_parameter_table(out, SpeciesAppearance());
  out << "\n## `competition`: a list of rows\n\nHow much each species (column, in the order of `species`) "
         "hinders the "
         "growth of each (row), 0 … "
      << max_competition << ". Without it all hinder each other, and themselves, with 1.\n";
  out << "\n## `growth_curves`: a map of `grass`, `mesquite` and `shrub`\n\nHow the plants of the slab model "
         "nield_baas grow: lists of 2 to "
      << GrowthCurve::capacity
      << " points `[burial in m a year, change of the effectiveness a year]` in ascending order of burial, "
         "linear "
         "in between, constant beyond. What is not given is that of config/growth_curves/nield_baas.yaml.\n";
  out << "\n## `terrain`: a list of steps, in order\n";
  terrain_steps(out);
  out << "\n## What cannot change while a simulation runs\n\n";
  for (const FixedParameter& fixed : fixed_parameters)
    out << "- `" << fixed.path << "`: " << fixed.reason << ".\n";
  out << "\nAll else can: `dynamic_reconfigure`, `~reload_parameters`.\n";
  constexpr const char* kinds[] = {"persistent", "held for run.hold_time", "derived", "on request"};
  out << "\n## Layers\n\n| layer | unit | kind | what |\n|---|---|---|---|\n";
  for (const LayerInfo& layer : layer_table)
    out << "| `" << layer.name << "` | " << layer.unit << " | " << kinds[static_cast<int>(layer.lifetime)]
        << " | " << layer.doc << " |\n";
  return out.str();
}

}  // namespace desert_sim
