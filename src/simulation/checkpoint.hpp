#pragma once
/// Checkpoints: a whole simulation in a file.
///
/// Format: the line "desert_sim checkpoint", version (u32), length of the header (u64), header (YAML:
/// scenario now and at its start, clock, wind regime, height scale, accounts of material, layers), the
/// layers' words as stored, the plants' columns, XXH3-64 of all before. All numbers are little-endian. Files
/// are written by write_file(), so that a file of that name is always whole.

#include <memory>
#include <string>

#include "src/simulation/simulation.hpp"

namespace desert_sim {

/// The content of a checkpoint; write_file() needs no simulation.
std::string checkpoint_bytes(const Simulation& simulation);
/// Throws ConfigError if the file cannot be written.
void save_checkpoint(const std::string& path, const Simulation& simulation);
/// Throws ConfigError if the file is missing, larger than the memory, not below `folder` if one is given, of
/// another version, cut off or corrupt, or if its checksum is right but a simulation could not have saved it:
/// fields or values out of their ranges, layers that the scenario does not go with, accounts that do not
/// close. No layer is allocated for what is longer than the file.
std::unique_ptr<Simulation> load_checkpoint(const std::string& path, Exec& exec,
                                            const std::string& folder = "");
/// The simulation of checkpoint_bytes(), which `name` names in messages. Throws ConfigError as
/// load_checkpoint() does.
std::unique_ptr<Simulation> simulation_from_bytes(const std::string& bytes, Exec& exec,
                                                  const std::string& name);

}  // namespace desert_sim
