#include "src/tools/bench_report.hpp"

#include <algorithm>
#include <cstdarg>
#include <cstdio>

#include "src/simulation/memory/memory.hpp"
#include "src/tools/json.hpp"

namespace desert_sim {

namespace {

/// A text formatted as by printf(), of at most 511 bytes.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...) {
  char text[512];
  va_list values;
  va_start(values, format);
  std::vsnprintf(text, sizeof text, format, values);
  va_end(values);
  return text;
}

}  // namespace

double BenchReport::median_ms() const {
  std::vector<double> sorted = block_times_ms;
  std::sort(sorted.begin(), sorted.end());
  return sorted.empty() ? 0 : sorted[sorted.size() / 2];
}

double BenchReport::bytes() const {
  double sum = 0;
  for (const Process& process : processes) sum += process.bytes;
  return sum;
}

double BenchReport::copy_bandwidth_fraction(double bytes_a_cell, double ms) const {
  return ms > 0 && copy_bandwidth > 0 ? bytes_a_cell * cells() / (ms * 1e-3) / copy_bandwidth : 0;
}

std::string bench_text(const BenchReport& r) {
  const double ms = r.median_ms();
  const auto [fastest, slowest] = std::minmax_element(r.block_times_ms.begin(), r.block_times_ms.end());
  std::string text =
      formatted("scene %s, %d x %d cells of %g m, %s (%s), quality %s, %d steps after %llu\n",
                r.scene.c_str(), r.width, r.height, r.cell_size, r.backend.c_str(), r.device.c_str(),
                r.quality.c_str(), r.steps, static_cast<unsigned long long>(r.warm_up));
  text += formatted("  %-12s %10.4f ms (median of %zu; %.4f ... %.4f)  %.2f M cell-steps/s\n", "whole step",
                    ms, r.block_times_ms.size(), *fastest, *slowest, r.cells() / ms * 1e-3);
  text +=
      formatted("  %-12s %10.1f GB/s; the least traffic of a step, %.0f bytes per cell, is %.1f %% of it\n",
                "copy", r.copy_bandwidth * 1e-9, r.bytes(), 100 * r.copy_bandwidth_fraction(r.bytes(), ms));
  for (const BenchReport::Process& p : r.processes)
    text += formatted("  %-12s %10.4f ms  at least %5.1f bytes per cell: %5.1f %% of copy speed\n",
                      p.name.c_str(), p.milliseconds, p.bytes,
                      100 * r.copy_bandwidth_fraction(p.bytes, p.milliseconds));
  text += formatted(
      "  residual     %.4f %% of cells over 1e-3, %.4f %% over 1e-2, mean excess %.5f, largest %.5f; %.1f "
      "sweeps of the fine grid per step\n",
      100 * r.residual.share_over_1e3, 100 * r.residual.share_over_1e2, r.residual.mean_excess,
      r.residual.largest_excess, r.fine_sweeps);
  text += formatted("  sand lost    %lld quanta of %lld\n", r.sand.residual(), r.sand.initial);
  const double bytes = static_cast<double>(total_bytes(r.memory));
  text += formatted("  memory       %.1f bytes per cell, %.1f MiB:", bytes / r.cells(), bytes / 1048576);
  for (const MemoryPart& part : r.memory)
    text += formatted(" %s %.1f,", part.name.c_str(), static_cast<double>(part.bytes) / r.cells());
  text.back() = '\n';
  return text;
}

std::string bench_json(const BenchReport& r) {
  const double ms = r.median_ms();
  Json all = {{"format", "desert_bench 1"},
              {"scene", r.scene},
              {"width", r.width},
              {"height", r.height},
              {"cell_size_m", r.cell_size},
              {"quality", r.quality},
              {"backend", r.backend},
              {"device", r.device},
              {"threads", r.threads},
              {"warm_up_steps", r.warm_up},
              {"steps", r.steps},
              {"ms_per_step", ms},
              {"ms_per_step_repeats", r.block_times_ms},
              {"copy_bytes_per_s", r.copy_bandwidth},
              {"bytes_per_cell", r.bytes()},
              {"share_of_copy", r.copy_bandwidth_fraction(r.bytes(), ms)},
              {"processes", Json::object()}};
  for (const BenchReport::Process& p : r.processes)
    all["processes"][p.name] = {{"ms", p.milliseconds},
                                {"bytes_per_cell", p.bytes},
                                {"share_of_copy", r.copy_bandwidth_fraction(p.bytes, p.milliseconds)}};
  all["residual"] = json_of(r.residual);
  all["fine_sweeps"] = r.fine_sweeps;
  all["sand_lost_quanta"] = r.sand.residual();
  all["sand_lost_share"] = r.sand.relative_residual();
  all["memory_bytes_per_cell"] = static_cast<double>(total_bytes(r.memory)) / r.cells();
  for (const MemoryPart& part : r.memory) all["memory_bytes"][part.name] = part.bytes;
  return json_text(all);
}

}  // namespace desert_sim
