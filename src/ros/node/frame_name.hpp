#pragma once
/// Names of frames as parameters.

#include <string>

namespace desert_sim {

class Faults;

/// Takes a leading '/' off, which tf2 does not know; a fault, naming `key`, if this is not the name of a
/// frame.
void check_frame(std::string& frame, const std::string& key, Faults& faults);

}  // namespace desert_sim
