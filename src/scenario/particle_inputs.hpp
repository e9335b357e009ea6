#pragma once
/// What a step of flying grains (kernels/particles/wang.hpp) takes from a scenario.

#include "kernels/particles/wang.hpp"
#include "src/scenario/sand_model.hpp"
#include "src/scenario/scenario.hpp"

namespace desert_sim {

inline bool has_flying_grains(const Scenario& s) { return s.get<SandParameters>().model == SandModel::wang; }

/// `time_step` [s], `above`: the undisturbed wind [m/s].
inline particles::StepInputs particle_inputs(const Scenario& s, float time_step, wind::Vector above,
                                             float* impact_strength = nullptr) {
  return {s.get<ParticleParameters>(),
          s.get<ReposeParameters>(),
          s.get<SaltationParameters>(),
          time_step,
          above,
          impact_strength};
}

}  // namespace desert_sim
