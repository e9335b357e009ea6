#include "src/rviz/undo_text.hpp"

#include <cstdio>

namespace desert_sim {

namespace {

/// The names alone: values may be long lists.
std::string set_text(const Undo::Response& answer) {
  if (answer.terrain_replaced) return "the terrain is the one of before";
  std::string text;
  for (const std::string& setting : answer.settings)
    text += (text.empty() ? "" : ", ") + setting.substr(0, setting.find('='));
  return text.empty() ? "" : "set back: " + text;
}

std::string missing_text(const Undo::Response& answer) {
  std::string text;
  for (const ReturnedMaterial& material : answer.materials) {
    if (material.missing <= 0) continue;
    char volume[64];
    std::snprintf(volume, sizeof volume, "%.3g m³ of ", material.missing);
    text += (text.empty() ? "" : ", ") + (volume + material.material);
  }
  if (answer.missing_plants > 0)
    text += (text.empty() ? "" : ", ") + std::to_string(answer.missing_plants) + " plants";
  return text.empty() ? "" : "missing, because they have moved on: " + text;
}

}  // namespace

std::string turn_text(const Undo::Response& answer) {
  const std::string set = set_text(answer), missing = missing_text(answer);
  return set + (set.empty() || missing.empty() ? "" : "; ") + missing;
}

}  // namespace desert_sim
