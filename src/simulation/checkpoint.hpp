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
/// Throws ConfigError if the file is missing, larger than the memory, of another version, cut off or corrupt,
/// or not below `folder` if one is given.
std::unique_ptr<Simulation> load_checkpoint(const std::string& path, Exec& exec,
                                            const std::string& folder = "");

}  // namespace desert_sim
