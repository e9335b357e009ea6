#pragma once
/// Worlds of continuum transport for its tests.

#include <complex>
#include <functional>

#include "kernels/sand/continuum.hpp"
#include "src/core/constants.hpp"
#include "test/support/world.hpp"

namespace desert_sim::test {

using std::string;

/// A world whose sand has the depth depth(x, y) [m] at (x, y) [cells]. `level`: its surface is at 0, on
/// bedrock that lies as deep as that.
inline std::unique_ptr<Simulation> with_sand(Exec& exec, const string& yaml,
                                             const std::function<double(int, int)>& depth,
                                             bool level = false) {
  const Scenario scenario = parsed(yaml + "terrain: [raster: {layer: sand, file: sand}" +
                                   (level ? ", raster: {layer: bedrock, file: bedrock}]\n" : "]\n"));
  const RasterLoader loader = [&](const RasterRequest& request) {
    const double sign = request.path.find("bedrock") == string::npos ? 1 : -1;
    RasterField field;
    field.width = scenario.grid.width;
    field.height = scenario.grid.height;
    field.cell_size = scenario.grid.cell_size;
    for (int y = 0; y < field.height; ++y)
      for (int x = 0; x < field.width; ++x) field.values.push_back(static_cast<float>(sign * depth(x, y)));
    return field;
  };
  return std::make_unique<Simulation>(exec, scenario, loader);
}

/// The wind at 10 m over which the shear velocity is `ratio` times its threshold, with the default parameters
/// [m/s].
inline double wind_of(double ratio, const ShearStressParameters& p = {}) {
  const continuum::SaturatedFlux law(ContinuumParameters{}, shear_stress::shear_velocity_per_wind(p));
  return ratio * std::sqrt(static_cast<double>(law.threshold) / law.shields_per_wind_squared);
}
/// The saturated flux over level ground in that wind [m²/s].
inline double flux_of(double ratio) {
  const continuum::SaturatedFlux law(ContinuumParameters{}, 1.0);
  return law(static_cast<float>(ratio * ratio) * law.threshold, law.threshold);
}

inline double mean(const std::vector<float>& values) {
  double sum = 0;
  for (const float v : values) sum += static_cast<double>(v);
  return sum / static_cast<double>(values.size());
}

}  // namespace desert_sim::test
