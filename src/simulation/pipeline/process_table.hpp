#pragma once
/// All processes in the order of a step, and which of them a scenario has.

#include <vector>

#include "src/simulation/pipeline/process.hpp"

namespace desert_sim {

/// Most equal parts in which a step is done; see Pipeline::parts().
constexpr int max_parts_of_step = 256;

/// What a pipeline chooses from, with rules that fuse two processes.
struct ProcessTable {
  std::vector<Process> processes;
  std::vector<FusedProcesses> fused;

  /// Whether a scenario has it: it is active there, and gives way to none.
  bool is_active(const Process& process, const Scenario& scenario) const;
  /// Throws ConfigError with all that keeps the scenario from being run: steps that are too long for the
  /// wind series, an acceleration that needs too many, and what its processes say (Process::check).
  void require_runnable(const Scenario& scenario) const;
};

}  // namespace desert_sim
