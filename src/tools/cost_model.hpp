#pragma once
/// Cost model: the least memory traffic per cell of each process in a step, as the processes declare it
/// (Process::traffic). doc/contributing/performance.md shows the table.

#include <string>
#include <vector>

#include "src/simulation/pipeline/process.hpp"
#include "src/simulation/processes/processes.hpp"

namespace desert_sim {

struct ProcessCost {
  std::string process;
  MemoryTraffic traffic;
};

/// Costs of the processes for sand on bare rock, without soil, plants, water, open boundaries or abrasion.
/// For avalanching of quality `converged` only the first cycle is counted.
std::vector<ProcessCost> cost_model(const Scenario& scenario, const Grid& grid);

/// Least traffic of one process [bytes per cell and step]; 0 if it is not in the model.
double min_bytes(const std::vector<ProcessCost>& model, const std::string& process);

/// The costs on a large grid as rows of a markdown table, with one row for each of the avalanching presets
/// fast and good.
std::string cost_table();

}  // namespace desert_sim
