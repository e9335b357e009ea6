#include "src/tools/cost_model.hpp"

#include <cstdio>

namespace desert_sim {

namespace {

constexpr double layer = 4;  // bytes a cell

/// Passes of avalanching read ground, sand and tangents, and write sand. Each coarse level has a quarter of
/// the cells of the one below; it is filled (ground, sand twice, tangents), passed over, and read again
/// (sand, before and after). The fine grid is read for the first in passing. The last pass writes the
/// heights.
ProcessCost avalanches(const avalanching::Schedule& plan) {
  const int fine = plan.fine_passes();
  constexpr double heights = 1, filling = 4, handing_down = 2;
  double coarse = 0, cells = 1;
  for (std::size_t n = 1; n < 16; ++n) {
    cells /= 4;
    coarse += cells * (filling + 4 * plan.coarse_passes(n) + handing_down);
  }
  const std::string times = fine == 1 ? "" : " x " + std::to_string(fine);
  return {"avalanching", layer * (4 * fine + coarse + heights),
          "(bedrock, sand, tangents)" + times + "; levels", "sand" + times + "; levels; heights"};
}

}  // namespace

std::vector<ProcessCost> cost_model(const avalanching::Schedule& plan) {
  return {
      {"wind", 4 * layer, "heights; heights", "wind (2)"},
      {"wind_shadow", 3 * layer, "heights, wind (2) of every other row", "shadow"},
      {"echo_dunes", 6 * layer, "heights, wind (2); cliffs", "cliffs; echo"},
      {"saltation", 13 * layer, "sand, airborne, wind (2), shadow; landed, sand, shadow",
       "sand, landed; sand, airborne, tangents"},
      avalanches(plan),
  };
}

double fewest_bytes(const std::vector<ProcessCost>& model, const std::string& process) {
  for (const ProcessCost& cost : model)
    if (process == cost.process) return cost.bytes;
  return 0;
}

std::string cost_table() {
  std::string text;
  const auto add = [&text](const ProcessCost& cost, const std::string& name) {
    char bytes[16];
    std::snprintf(bytes, sizeof bytes, "%.0f", cost.bytes);
    text += "| " + name + " | " + cost.reads + " | " + cost.writes + " | " + bytes + " |\n";
  };
  for (const ProcessCost& cost : cost_model(avalanching::preset(AvalancheQuality::fast)))
    add(cost, std::string(cost.process) == "avalanching" ? "avalanching, fast" : cost.process);
  add(cost_model(avalanching::preset(AvalancheQuality::good)).back(), "avalanching, good");
  return text;
}

}  // namespace desert_sim
