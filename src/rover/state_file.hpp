#pragma once
/// The state of a rover in a file: to the bit.
///
/// Format: the line "desert_sim rover", version (u32), length and bytes of the rover's text (rover_text()),
/// condition (u32), whether it is placed (u32), length and bytes of the reason, all numbers of the state in
/// the order of for_each_number() (f64, u64), XXH3-64 of all before. All numbers are little-endian.

#include <string>

#include "src/rover/rover.hpp"

namespace desert_sim {

std::string rover_state_bytes(const Rover& rover);
/// Throws ConfigError that names `path` if the bytes are no state of this rover: of another version, cut
/// off, corrupt, of a rover with other parameters (it names the first one), or with numbers that no rover
/// can have.
RoverState rover_state_of(const std::string& bytes, const Rover& rover, const std::string& path);

/// Throws what write_file() throws.
void save_rover(const std::string& path, const Rover& rover);
/// With a `folder`, only of a file below it, as InputFile. Nothing is changed if it throws ConfigError.
void load_rover(const std::string& path, Rover& rover, const std::string& folder = "");

}  // namespace desert_sim
