#include "src/metrics/dune_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "src/core/error.hpp"
#include "src/core/number_text.hpp"

namespace desert_sim {

namespace {

void require_finite(const Field& f, const char* layer, double time) {
  for (std::size_t i = 0; i < f.values.size(); ++i)
    if (!std::isfinite(f.values[i]))
      throw ConfigError(std::string(layer) + " at " + number_text(time, 9) + " s: cell (" +
                        std::to_string(i % static_cast<std::size_t>(f.width)) + ", " +
                        std::to_string(i / static_cast<std::size_t>(f.width)) + ") is " +
                        number_text(static_cast<double>(f.values[i])) + " (allowed: finite values)");
}

double mean(const Field& f) {
  double sum = 0;
  for (float v : f.values) sum += static_cast<double>(v);
  return sum / static_cast<double>(f.values.size());
}

Motion motion_of(double x, double y) { return {std::hypot(x, y), direction_of(x, y)}; }

}  // namespace

DuneMetrics measure_dunes(const DuneSurface& s, const MetricSettings& settings) {
  require_finite(s.relief, "relief", s.time);
  require_finite(s.elevation, "elevation", s.time);
  require_finite(s.sand, "sand", s.time);
  const double sigma = settings.sigma > 0 ? settings.sigma : 2 * s.relief.cell_size;
  DuneMetrics m;
  m.time = s.time;
  m.rms_relief = roughness(s.relief);
  m.deepest_sand = static_cast<double>(*std::max_element(s.sand.values.begin(), s.sand.values.end()));
  if (settings.slab_height > 0) m.highest_stack = m.deepest_sand / settings.slab_height;
  const auto bare = std::count_if(s.sand.values.begin(), s.sand.values.end(), [&](float depth) {
    return static_cast<double>(depth) < settings.bare_depth;
  });
  m.bare_share = static_cast<double>(bare) / static_cast<double>(s.sand.values.size());
  m.slip_faces =
      slip_faces(s.elevation, s.sand, s.wind_x, s.wind_y, settings.steeper_than_deg, settings.least_depth);
  if (s.flux_x && s.flux_y) m.flux = motion_of(mean(*s.flux_x), mean(*s.flux_y));
  const Orientation crests = crest_orientation(s.relief, sigma);
  if (!(crests.coherence > 0)) return m;
  m.crests = crests;
  m.wavelength = wavelength(s.relief, crests.crest_deg + 90);
  m.lines = crest_lines(s.relief, crests.crest_deg, sigma);
  if (m.lines.length > 0)
    m.terminations_per_metre = static_cast<double>(m.lines.terminations) / m.lines.length;
  return m;
}

std::optional<Migration> migration(const DuneSurface& before, const DuneSurface& after) {
  const double elapsed = after.time - before.time;
  if (!(elapsed > 0))
    throw ConfigError("migration: the time " + number_text(after.time, 9) + " s does not follow " +
                      number_text(before.time, 9) + " s");
  const std::optional<Displacement> d = displacement(before.relief, after.relief);
  if (!d) return std::nullopt;
  return Migration{motion_of(d->x / elapsed, d->y / elapsed), d->correlation};
}

}  // namespace desert_sim
