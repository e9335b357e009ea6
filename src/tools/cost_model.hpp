#pragma once
/// The fewest bytes a cell that each process must move through memory in a step: every layer that a pass over
/// the grid reads or writes, once, four bytes each. The one table of it; test/bench/README.md shows it.

#include <string>
#include <vector>

#include "kernels/avalanching/avalanching.hpp"

namespace desert_sim {

struct ProcessCost {
  const char* process;
  double bytes;  ///< a cell and step
  std::string reads, writes;
};

/// Of a step of sand on bare rock with the default processes: no soil, plants, water, open edges or abrasion.
/// Avalanches of quality `converged` go on where they must; this counts the first cycle.
std::vector<ProcessCost> cost_model(const avalanching::Schedule& plan);

/// Of one process; 0 if the model does not have it.
double fewest_bytes(const std::vector<ProcessCost>& model, const std::string& process);

/// Rows of a markdown table; of avalanches by their presets.
std::string cost_table();

}  // namespace desert_sim
