#pragma once
/// Keys that scenarios had before sand.model: slab_model.kind, particle.kind and saltation.model, of which
/// two could name different models; and the section `detail`, which is now `micro_relief`. Scenarios that
/// say them are refused with the line to write instead. What programs saved with them (checkpoints,
/// journals, terrains) is read as before.

#include <string>

#include "src/core/validation_errors.hpp"
#include "src/scenario/sand_model.hpp"
#include "src/scenario/scenario.hpp"

namespace desert_sim {

/// What to write instead of a setting `path=value` with a former key; empty for all others.
std::string instead_of_former_key(const std::string& setting);

/// Adds an error for each former key, and returns the scenario without them.
YAML::Node refuse_former_keys(const YAML::Node& root, ValidationErrors& errors);

/// A scenario without its former keys: in their place stands sand.model. `root` itself stays as it is. Throws
/// ConfigError, in the name of `source`, if they name two models, or a section is there by both its names.
YAML::Node without_former_keys(const YAML::Node& root, const std::string& source);

/// The same for settings of a recorded command, where `present` moved the sand before.
Settings without_former_keys(const Settings& settings, SandModel present, const std::string& source);

/// The text of a scenario file with sand.model in the place of former keys. All else stays as it stands
/// there, comments too; a text without former keys is returned as it is. Throws ConfigError as
/// without_former_keys() does, for a text that is no YAML, and where a key is written in a way that only its
/// author can change.
std::string migrated(const std::string& text, const std::string& source);

}  // namespace desert_sim
