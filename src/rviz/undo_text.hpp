#pragma once
/// What is said of an undo or redo.

#include <desert_sim/Undo.h>

#include <string>

namespace desert_sim {

/// What of settings and terrain an undo or redo has set, and what it could not bring back; empty if it was an
/// exact one of edits.
std::string turn_text(const Undo::Response& answer);

/// Whether forms that show settings are to look again.
inline bool changes_settings(const Undo::Response& answer) {
  return !answer.settings.empty() || answer.terrain_replaced;
}

}  // namespace desert_sim
