#pragma once
/// What finds the wind over the ground is given in a step: wind.hpp and shear_stress.hpp.

#include "kernels/field/surface.hpp"
#include "kernels/wind/vector.hpp"

namespace desert_sim::wind {

struct FlowInputs {
  Vector above;                     ///< the undisturbed wind, w_a [m/s]
  const surface::Heights& heights;  ///< of the ground's surface
  Quanta reference = 0;             ///< about the height of the ground, h_ref [quanta]
  /// Of wind_features.hpp [m/s]; null where there are none.
  const float *perturbation_x = nullptr, *perturbation_y = nullptr;
};

}  // namespace desert_sim::wind
