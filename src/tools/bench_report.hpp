#pragma once
/// The measurements of desert_bench, formatted as text and as JSON.

#include <string>
#include <vector>

#include "kernels/avalanching/residual.hpp"
#include "src/simulation/simulation.hpp"

namespace desert_sim {

struct BenchReport {
  struct Process {
    std::string name;
    double milliseconds = 0;  ///< time per step, measured separately, synchronisation included
    double bytes = 0;         ///< least traffic per cell and step (cost_model.hpp); 0: not modelled
  };

  std::string scene, backend, device, quality;
  int width = 0, height = 0, threads = 0;  ///< threads of the CPU backend; 0 on a GPU
  double cell_size = 0;                    ///< [m]
  std::uint64_t warm_up = 0;               ///< steps before the timing, including those of a checkpoint
  int steps = 0;                           ///< steps after the warm-up, before the residual was computed
  std::vector<double> block_times_ms;      ///< time per step in each block of steps [ms]
  double copy_bandwidth = 0;  ///< bandwidth of a copy on the same device, read and written [bytes/s]
  std::vector<Process> processes;
  Residual residual;
  double fine_sweeps = 0;  ///< mean sweeps of avalanching over the fine grid per step
  MaterialBalance sand;
  std::vector<MemoryPart> memory;

  double cells() const { return static_cast<double>(width) * height; }
  double median_ms() const;  ///< time per step: the median of the repeats
  double bytes() const;      ///< least traffic per cell and step of all processes
  /// Bandwidth of `bytes_a_cell` bytes per cell in `ms` milliseconds, relative to that of a copy.
  double copy_bandwidth_fraction(double bytes_a_cell, double ms) const;
};

/// The report as text for people.
std::string bench_text(const BenchReport& report);
/// The report as one JSON object; doc/contributing/performance.md describes its fields.
std::string bench_json(const BenchReport& report);

}  // namespace desert_sim
