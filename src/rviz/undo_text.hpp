#pragma once
/// What is said of an undo or redo.

#include <desert_sim/Undo.h>

#include <string>

namespace desert_sim {

/// What an undo or redo could not bring back; empty if it was exact.
std::string missing_text(const Undo::Response& answer);

}  // namespace desert_sim
