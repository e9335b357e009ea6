#pragma once
/// Wind regimes by the names that Fryberger & Dean (1979) give them, as segments of a wind schedule.

#include <vector>

namespace desert_sim {

struct WindPreset {
  struct Segment {
    double direction_deg;  ///< where it blows to, counter-clockwise from east
    double speed;          ///< [m/s]
    double weight;         ///< how often it is drawn; in a timeline its share of time
  };
  const char* name;
  const char* dunes;  ///< which such a wind makes
  std::vector<Segment> segments;
};

/// The simulated time for which a segment of weight 1 lasts in a timeline, and its ramp [s].
constexpr double preset_duration = 60, preset_ramp = 5;

inline std::vector<WindPreset> wind_presets() {
  return {
      {"unidirectional (narrow unimodal)",
       "barchans and transverse dunes",
       {{0, 7, 4}, {15, 7, 1}, {-15, 7, 1}}},
      {"wide unimodal", "barchanoid ridges", {{0, 7, 2}, {30, 7, 1}, {-30, 7, 1}}},
      {"acute bimodal", "linear dunes, and barchans with one long horn", {{35, 7, 1}, {-35, 7, 1}}},
      {"obtuse bimodal", "linear dunes", {{60, 7, 1}, {-60, 7, 1}}},
      {"complex (star dunes)", "star dunes", {{0, 7, 1}, {120, 7, 1}, {240, 7, 1}}},
      {"seasonal reversal", "reversing dunes", {{0, 7, 3}, {180, 7, 2}}},
  };
}

}  // namespace desert_sim
