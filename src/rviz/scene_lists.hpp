#pragma once
/// What can be loaded by name.

#include <QStringList>
#include <string>

namespace desert_sim {

struct SceneLists {
  QStringList installed;    ///< names of config/scenarios, which every node takes
  QStringList scenarios;    ///< YAML files below the node's ~data_dir, and folders that ~save_scenario wrote
  QStringList terrains;     ///< folders and bags there, for ~load_terrain
  QStringList checkpoints;  ///< there, with the extension .ckpt
};

/// Asks rospack, the parameter server and the disk; may take a while. What lies on another machine than this
/// one is not listed.
SceneLists list_scenes(const std::string& node);

/// The presets of species, of config/species.
QStringList list_species();

/// Gives a name that means both an installed scenario and a saved one as the node takes it for either.
void name_apart(SceneLists& lists);

/// The lists of one ~data_dir, without `installed`.
SceneLists list_folder(const std::string& data_dir);

}  // namespace desert_sim
