#include "src/tools/bench_report.hpp"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <sstream>

#include "src/simulation/memory/memory.hpp"
#include "src/tools/json_text.hpp"

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
  std::ostringstream out;
  const auto number = [](double value) { return json_number(value); };
  const double ms = r.median_ms();
  out << "{\n  \"format\": \"desert_bench 1\",\n  \"scene\": " << json_string(r.scene)
      << ",\n  \"width\": " << r.width << ",\n  \"height\": " << r.height
      << ",\n  \"cell_size_m\": " << number(r.cell_size) << ",\n  \"quality\": " << json_string(r.quality)
      << ",\n  \"backend\": " << json_string(r.backend) << ",\n  \"device\": " << json_string(r.device)
      << ",\n  \"threads\": " << r.threads << ",\n  \"warm_up_steps\": " << r.warm_up
      << ",\n  \"steps\": " << r.steps << ",\n  \"ms_per_step\": " << number(ms)
      << ",\n  \"ms_per_step_repeats\": [";
  for (std::size_t n = 0; n < r.block_times_ms.size(); ++n)
    out << (n ? ", " : "") << number(r.block_times_ms[n]);
  out << "],\n  \"copy_bytes_per_s\": " << number(r.copy_bandwidth)
      << ",\n  \"bytes_per_cell\": " << number(r.bytes())
      << ",\n  \"share_of_copy\": " << number(r.copy_bandwidth_fraction(r.bytes(), ms))
      << ",\n  \"processes\": {";
  for (std::size_t n = 0; n < r.processes.size(); ++n) {
    const BenchReport::Process& p = r.processes[n];
    out << (n ? ",\n    " : "\n    ") << json_string(p.name) << ": {\"ms\": " << number(p.milliseconds)
        << ", \"bytes_per_cell\": " << number(p.bytes)
        << ", \"share_of_copy\": " << number(r.copy_bandwidth_fraction(p.bytes, p.milliseconds)) << "}";
  }
  out << "\n  },\n  \"residual\": {\"share_over_1e-3\": " << number(r.residual.share_over_1e3)
      << ", \"share_over_1e-2\": " << number(r.residual.share_over_1e2)
      << ", \"mean_excess\": " << number(r.residual.mean_excess)
      << ", \"largest_excess\": " << number(r.residual.largest_excess)
      << "},\n  \"fine_sweeps\": " << number(r.fine_sweeps)
      << ",\n  \"sand_lost_quanta\": " << r.sand.residual()
      << ",\n  \"sand_lost_share\": " << number(r.sand.relative_residual())
      << ",\n  \"memory_bytes_per_cell\": " << number(static_cast<double>(total_bytes(r.memory)) / r.cells())
      << ",\n  \"memory_bytes\": {";
  for (std::size_t n = 0; n < r.memory.size(); ++n)
    out << (n ? ", " : "") << json_string(r.memory[n].name) << ": " << r.memory[n].bytes;
  out << "}\n}\n";
  return out.str();
}

}  // namespace desert_sim
