#pragma once
/// The metrics of dunes that programs report. doc/science/comparing.md defines each for users.

#include <optional>
#include <vector>

#include "src/metrics/correlation.hpp"
#include "src/metrics/crest_lines.hpp"
#include "src/metrics/crest_orientation.hpp"
#include "src/metrics/slip_faces.hpp"

namespace desert_sim {

/// A terrain at one time. All fields have the same grid.
struct DuneSurface {
  double time = 0;                      ///< [s]
  Field relief;                         ///< what dunes are measured on: depth of sand or elevation [m]
  Field elevation, sand;                ///< [m]
  Field wind_x, wind_y;                 ///< at the surface [m/s]
  std::optional<Field> flux_x, flux_y;  ///< sand that the wind carries through a metre of width [m²/s]
};

struct MetricSettings {
  double sigma = 0;              ///< of the smoothing before crests are looked for [m]; 0: two cells
  double steeper_than_deg = 30;  ///< slip faces
  double least_depth = 0.1;      ///< of sand on slip faces [m]
  double bare_depth = 0.02;      ///< ground with less sand is bare [m]
  double slab_height = 0;        ///< of a slab model [m]; 0: none
};

/// A vector as speed (or flux) and direction.
struct Motion {
  double amount = 0;         ///< [m/s] or [m²/s]
  double direction_deg = 0;  ///< where to, counter-clockwise from +x
};

struct DuneMetrics {
  double time = 0;                    ///< [s]
  std::optional<Orientation> crests;  ///< empty of a plane relief
  std::optional<double> wavelength;   ///< across the crests [m]
  CrestLines lines;
  double rms_relief = 0;                         ///< about the mean [m]
  double deepest_sand = 0;                       ///< [m]
  std::optional<double> highest_stack;           ///< deepest sand [slabs]
  std::optional<double> terminations_per_metre;  ///< of crest lines
  SlipFaces slip_faces;
  double bare_share = 0;       ///< of cells
  std::optional<Motion> flux;  ///< mean over all cells
};

/// Throws ConfigError that names layer, time and cell where a value is not finite.
DuneMetrics measure_dunes(const DuneSurface& surface, const MetricSettings& settings);

/// Mean motion of the pattern from one time to a later one, and the correlation that it rests on.
struct Migration {
  Motion velocity;
  double correlation = 0;
};

/// From displacement() of the reliefs. Throws ConfigError unless time rises.
std::optional<Migration> migration(const DuneSurface& before, const DuneSurface& after);

}  // namespace desert_sim
