#include "src/simulation/processes/limits.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "kernels/base/quanta.hpp"

namespace desert_sim {

double fastest_wind(const Scenario& s) {
  double fastest = s.wind_regime.speed;
  for (const WindSegment& segment : s.wind_segments)
    fastest = std::max(fastest, static_cast<double>(segment.speed));
  if (s.wind_series) fastest = std::max(fastest, s.wind_series->fastest());
  return fastest * static_cast<double>(std::max(s.wind.speedup_highest, s.wind.response_highest));
}

void check_reach(const Scenario& s, const char* key, double metres, ValidationErrors& errors) {
  const double cells = metres / s.grid.cell_size;
  if (cells > max_displacement)
    errors.add(key, "reaches across " + std::to_string(static_cast<long long>(cells)) + " cells of " +
                        std::to_string(s.grid.cell_size) +
                        " m (allowed: " + std::to_string(max_displacement) + ")");
}

void check_substeps(const Scenario& s, const Substeps& n, ValidationErrors& errors) {
  if (n.count <= n.most) return;
  char text[200];
  std::snprintf(
      text, sizeof text,
      "%g %s needs %.0f sub-steps a step with cells of %g m and steps of %g s (allowed: at most %d, "
      "which %g %s needs)",
      n.value, n.unit, std::ceil(n.count), static_cast<double>(s.grid.cell_size),
      static_cast<double>(s.run.time_step), n.most, n.value * n.most / n.count, n.unit);
  errors.add(n.key, text);
}

void check_step_length(const Scenario& s, const char* key, double interval, ValidationErrors& errors) {
  constexpr int most = 256;
  const double step = s.run.time_step;
  if (step <= most * interval) return;
  char text[200];
  std::snprintf(text, sizeof text, "%g s is %g times %s = %g s (allowed: at most %d times, %g s)", step,
                step / interval, key, interval, most, most * interval);
  errors.add("run.time_step", text);
}

}  // namespace desert_sim
