#include "src/simulation/views/view_sections.hpp"

#include "kernels/micro_relief/micro_relief_parameters.hpp"

namespace desert_sim {

namespace {

const std::string rover_section = register_section<TraversabilityParameters>("traversability");
const std::string ground_section = register_section<WheelGroundParameters>("wheel_ground");
const std::string micro_relief_section = register_section<MicroReliefParameters>("micro_relief");

}  // namespace

traversability::Rover rover_of(const Scenario& s) {
  return {s.get<TraversabilityParameters>(), s.get<WheelGroundParameters>(), s.get<ReposeParameters>()};
}

}  // namespace desert_sim
