#include "src/rover/simulated_ground.hpp"

#include <utility>

namespace desert_sim {

SimulatedGround::SimulatedGround(Scenario scenario, RasterLoader load_raster, const std::string& backend,
                                 int threads)
    : scenario_(std::move(scenario)),
      load_raster_(std::move(load_raster)),
      backend_(backend),
      threads_(threads) {}

const GroundSource& SimulatedGround::at(std::uint64_t step) {
  if (ground_ && step == step_) return *ground_;
  if (!session_ || session_->simulation().state().steps > step)
    session_ = std::make_unique<Session>(scenario_, load_raster_, backend_, threads_);
  while (session_->simulation().state().steps < step) session_->step();
  ground_ = std::make_unique<GridGround>(*session_->simulation().snapshot(GridGround::layers_of_snapshot()),
                                         scenario_.repose.moisture_capacity);
  step_ = step;
  return *ground_;
}

}  // namespace desert_sim
