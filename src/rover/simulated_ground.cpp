#include "src/rover/simulated_ground.hpp"

#include <utility>

namespace desert_sim {

SimulatedGround::SimulatedGround(Scenario scenario, RasterLoader load_raster, const std::string& backend,
                                 int threads, bool micro_relief)
    : scenario_(std::move(scenario)),
      load_raster_(std::move(load_raster)),
      backend_(backend),
      threads_(threads),
      micro_relief_(micro_relief) {}

const GroundSource& SimulatedGround::at(std::uint64_t step) {
  if (ground_ && step == step_) return *ground_;
  if (!session_ || session_->simulation().state().steps > step)
    session_ = std::make_unique<Session>(scenario_, load_raster_, backend_, threads_);
  while (session_->simulation().state().steps < step) session_->step();
  const auto snapshot = session_->simulation().views().snapshot(GridGround::layers_of_snapshot(micro_relief_),
                                                                {}, micro_relief_);
  const ReposeParameters& repose = scenario_.get<ReposeParameters>();
  const double capacity = repose.moisture_capacity, depth = repose.moisture_depth;
  ground_ = micro_relief_ ? GridGround::with_micro_relief(*snapshot, capacity, depth)
                          : std::make_unique<GridGround>(*snapshot, capacity, depth);
  step_ = step;
  return *ground_;
}

}  // namespace desert_sim
