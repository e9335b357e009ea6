#pragma once
/// The section `detail` of a scenario.

#include "kernels/detail/detail_parameters.hpp"
#include "src/scenario/scenario.hpp"

namespace desert_sim {

const DetailParameters& detail_parameters(const Scenario& scenario);

}  // namespace desert_sim
