#pragma once
/// The ground of a simulation in the same program, for rovers without ROS and for replays of their journals.

#include <memory>
#include <string>

#include "src/rover/grid_ground.hpp"
#include "src/scenario/scenario.hpp"
#include "src/simulation/session.hpp"

namespace desert_sim {

class SimulatedGround {
 public:
  /// `micro_relief`: whether the ground has ripples and bumps.
  SimulatedGround(Scenario scenario, RasterLoader load_raster, const std::string& backend, int threads,
                  bool micro_relief = false);

  /// The ground at this step since the scenario's start. An earlier step than the last one begins anew. What
  /// it returns stays valid until the next call.
  const GroundSource& at(std::uint64_t step);

 private:
  const Scenario scenario_;
  const RasterLoader load_raster_;
  const std::string backend_;
  const int threads_;
  const bool micro_relief_;
  std::unique_ptr<Session> session_;
  std::unique_ptr<GridGround> ground_;
  std::uint64_t step_ = 0;  ///< of ground_
};

}  // namespace desert_sim
