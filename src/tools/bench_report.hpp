#pragma once
/// What desert_bench measured, as text for people and as JSON for programs.

#include <string>
#include <vector>

#include "src/simulation/simulation.hpp"

namespace desert_sim {

struct BenchReport {
  struct Process {
    std::string name;
    double milliseconds = 0;  ///< a step, timed by itself; includes the wait for the device
    double bytes = 0;         ///< fewest a cell (cost_model.hpp); 0: not in the model
  };

  std::string scene, backend, device, quality;
  int width = 0, height = 0, threads = 0;  ///< threads of the CPU; 0 on a GPU
  double cell_size = 0;                    ///< [m]
  std::uint64_t warm_up = 0;    ///< steps done before the scene's timing began, of its checkpoint or by us
  int steps = 0;                ///< after that, until the residual was taken
  std::vector<double> repeats;  ///< milliseconds a step of each block of steps
  double copied = 0;            ///< bytes a second that a copy reads and writes, measured on the same device
  std::vector<Process> processes;
  Residual residual;
  double fine_sweeps = 0;  ///< of avalanching, a step
  MaterialBalance sand;
  std::vector<MemoryPart> memory;

  double cells() const { return static_cast<double>(width) * height; }
  double milliseconds() const;  ///< a step: the repeats' median
  double bytes() const;         ///< fewest a cell of all processes
  /// Bytes a cell in so many milliseconds, over what a copy moves in that time.
  double share_of_copy(double bytes_a_cell, double ms) const;
};

std::string bench_text(const BenchReport& report);
/// One object; its fields are in test/bench/README.md.
std::string bench_json(const BenchReport& report);

}  // namespace desert_sim
