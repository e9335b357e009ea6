#include "src/rviz/undo_text.hpp"

#include <cstdio>

namespace desert_sim {

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

}  // namespace desert_sim
