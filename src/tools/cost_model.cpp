#include "src/tools/cost_model.hpp"

#include <cstdio>

#include "kernels/avalanching/avalanching_parameters.hpp"

namespace desert_sim {

std::vector<ProcessCost> cost_model(const Scenario& scenario, const Grid& grid) {
  std::vector<ProcessCost> model;
  for (const Process& process : process_table().processes)
    if (process.traffic) model.push_back({process.name, process.traffic(scenario, grid)});
  return model;
}

double min_bytes(const std::vector<ProcessCost>& model, const std::string& process) {
  for (const ProcessCost& cost : model)
    if (process == cost.process) return cost.traffic.bytes;
  return 0;
}

std::string cost_table() {
  std::string text;
  const auto add = [&text](const ProcessCost& cost, const std::string& name) {
    char bytes[16];
    std::snprintf(bytes, sizeof bytes, "%.0f", cost.traffic.bytes);
    text += "| " + name + " | " + cost.traffic.reads + " | " + cost.traffic.writes + " | " + bytes + " |\n";
  };
  const Grid large{4096, 4096, 1.0f};
  Scenario scenario;
  scenario.get<AvalanchingParameters>().quality = AvalancheQuality::fast;
  for (const ProcessCost& cost : cost_model(scenario, large))
    add(cost, cost.process == "avalanching" ? "avalanching, fast" : cost.process);
  scenario.get<AvalanchingParameters>().quality = AvalancheQuality::good;
  for (const ProcessCost& cost : cost_model(scenario, large))
    if (cost.process == "avalanching") add(cost, "avalanching, good");
  return text;
}

}  // namespace desert_sim
