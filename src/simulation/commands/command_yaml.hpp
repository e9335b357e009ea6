#pragma once
/// Commands to and from YAML, for the journal.

#include <string>

#include "src/simulation/commands/command.hpp"

namespace YAML {
class Node;
class Emitter;
}  // namespace YAML

namespace desert_sim {

/// Writes the entries `command: NAME` and its parameters into an open map.
void emit_command(YAML::Emitter& out, const Command& command);
/// Writes the entries of a patch, its values as base64 of 32-bit floats: every bit is kept.
void emit_patch(YAML::Emitter& out, const command::Patch& patch);
/// `source` names the file and line in errors. Throws ConfigError.
Command read_command(const YAML::Node& node, const std::string& source);

/// A wind regime with its state, into an open map; used by the checkpoint too.
void emit_regime(YAML::Emitter& out, const WindRegime& regime);
WindRegime read_regime(const YAML::Node& node, const std::string& source);

}  // namespace desert_sim
