#include "src/simulation/editing/timeline_rasters.hpp"

#include <yaml-cpp/yaml.h>

#include <cmath>

#include "src/core/error.hpp"
#include "src/core/number_text.hpp"
#include "src/core/validation_errors.hpp"
#include "src/scenario/yaml_parameters.hpp"
#include "src/simulation/commands/command_yaml.hpp"
#include "src/simulation/commands/patch_raster.hpp"

namespace desert_sim {

namespace {

/// What heights are multiplied by; none of a mask.
std::optional<double> scale_of(const YAML::Node& command) {
  const YAML::Node use = command["patch_use"], given = command["image_scale"];
  const bool mask = use && use.IsScalar() && use.Scalar() == patch_uses[static_cast<int>(PatchUse::mask)];
  if (mask && given)
    throw ConfigError("image_scale: is given, but a mask does not use it (allowed: leave it out)");
  if (mask) return std::nullopt;
  double scale = 1;
  if (given && !(yaml::decode_number(given, "m", scale) && std::isfinite(scale)))
    throw ConfigError("image_scale: " + yaml::node_text(given) + " is not a finite number");
  return scale;
}

/// The patch of a command that names a raster.
command::Patch patch_of(const YAML::Node& command, const Scenario& scenario,
                        const RasterLoader& load_raster) {
  const YAML::Node file = command["image_file"];
  if (!file.IsScalar() || file.Scalar().empty())
    throw ConfigError("image_file: " + yaml::node_text(file) + " is not the name of a file");
  if (command["patch"]) throw ConfigError("image_file: is given beside `patch` (allowed: one of both)");
  return patch_of_raster(load_raster, raster_path(scenario, file.Scalar()), file.Scalar(), scale_of(command));
}

/// The command as text, with the patch in the place of the raster's name.
std::string with_patch(YAML::Node command, const command::Patch& patch) {
  for (const char* key : {"image_file", "image_scale"}) command.remove(key);
  YAML::Emitter out;
  yaml::set_full_precision(out);
  out.SetMapFormat(YAML::Flow);
  out.SetSeqFormat(YAML::Flow);
  out << YAML::BeginMap;
  for (const auto& part : command) out << YAML::Key << part.first << YAML::Value << part.second;
  emit_patch(out, patch);
  out << YAML::EndMap;
  return out.c_str();
}

}  // namespace

void read_timeline_rasters(Scenario& scenario, const RasterLoader& load_raster) {
  ValidationErrors errors(scenario.name);
  long long cells = 0;
  for (std::size_t n = 0; n < scenario.timeline.size() && !errors.is_full(); ++n) {
    TimelineEntry& entry = scenario.timeline[n];
    if (timeline_raster(entry).empty()) continue;
    try {
      const YAML::Node command = YAML::Load(entry.command);
      const command::Patch patch = patch_of(command, scenario, load_raster);
      cells += static_cast<long long>(patch.columns) * patch.rows;
      if (cells > command::Patch::max_pixels)
        throw ConfigError("image_file: the rasters of the timeline have more than " +
                          std::to_string(command::Patch::max_pixels) + " cells together");
      entry.command = with_patch(command, patch);
    } catch (const ConfigError& e) {
      errors.add("run.timeline." + std::to_string(n) + " (at " + number_text(entry.time, 9) + " s)",
                 e.what());
    }
  }
  errors.throw_if_any();
}

}  // namespace desert_sim
