#pragma once
/// The sections of what is looked at and changes no terrain: `traversability` and `wheel_ground`, for the
/// costs of a rover, and `micro_relief`.

#include "kernels/rover/traversability.hpp"
#include "src/scenario/scenario.hpp"

namespace desert_sim {

/// The rover of the section traversability on the ground of wheel_ground.
traversability::Rover rover_of(const Scenario& scenario);

}  // namespace desert_sim
