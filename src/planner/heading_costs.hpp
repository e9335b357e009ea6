#pragma once
/// What a straight way costs by what a rover feels on it: slope, slip and sinkage as it heads, water and
/// wind.
///
///   a metre costs 1 + w_slip max(s, 0) + w_cross tan β + w_sinkage z + w_water d + w_flow d |v|
///                   + w_wind max(−u·e, 0)
///
/// with the slip s and the drift tan β for the heading e, from the layers slip (up the steepest line),
/// slip_downhill and slip_across, and f the cosine of the angle between the heading and uphill:
///
///   s(f) = (s_up + s_down)/2 + f |f| (s_up − s_down)/2,   tan β = (1 − f²) slip_across
///
/// which is exact for the law `light` of wheel_ground.hpp. z is the sinkage [m], d the depth of water [m], v
/// its velocity, u the wind [m/s]. What CostGrid calls lethal has no cost.

#include <memory>
#include <optional>
#include <vector>

#include "src/planner/grid_path.hpp"

namespace desert_sim {

struct HeadingWeights {
  double slip = 4;      ///< [1]
  double drift = 4;     ///< [1]
  double sinkage = 20;  ///< [1/m]
  double water = 10;    ///< [1/m]
  double flow = 15;     ///< [s/m²]
  double wind = 0.02;   ///< of headwind [s/m]
};

/// Layers, row by row from the south-west; empty ones count as 0.
struct HeadingLayers {
  std::vector<float> elevation, slip, slip_downhill, slip_across, sinkage, water_depth, water_velocity_x,
      water_velocity_y, wind_x, wind_y;
};

class HeadingCosts {
 public:
  /// Throws ConfigError for layers of another size than the grid.
  HeadingCosts(std::shared_ptr<const CostGrid> grid, HeadingLayers layers, const HeadingWeights& weights);

  const CostGrid& grid() const { return *grid_; }
  /// What a way costs, at least its length [m]; none if it meets a lethal cell. Samples are a cell apart at
  /// most.
  std::optional<double> line(const GridPoint& from, const GridPoint& to) const;
  std::optional<double> path(const GridPath& path) const;
  /// What a metre costs at a point for a heading of unit length; none where it is lethal.
  std::optional<double> metre(const GridPoint& at, double east, double north) const;

 private:
  double value(const std::vector<float>& layer, std::size_t i) const {
    return layer.empty() ? 0 : static_cast<double>(layer[i]);
  }
  std::shared_ptr<const CostGrid> grid_;
  HeadingLayers layers_;
  HeadingWeights weights_;
};

}  // namespace desert_sim
