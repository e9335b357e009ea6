#pragma once
/// The velocity of water from the fluxes that a step has left, for who looks at a state before its next step:
/// only fluxes are kept.
///
///   U_x = ½(q_west + q_east)/(l w),   U_y = ½(q_south + q_north)/(l w)
///
/// Through an open edge flows what comes to it; films (face_flow.hpp) have no velocity. Reads water,
/// water_flux_x, water_flux_y; writes water_velocity_x, water_velocity_y.

#include "kernels/field/layers.hpp"

namespace desert_sim::water_velocity {

template <class E>
void step(E& exec, const TerrainView& t);

}  // namespace desert_sim::water_velocity
