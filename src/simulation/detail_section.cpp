#include "src/simulation/detail_section.hpp"

#include <string>

namespace desert_sim {

namespace {

const std::string section = register_section<DetailParameters>("detail");

}  // namespace

const DetailParameters& detail_parameters(const Scenario& scenario) {
  return scenario.process_sections.get<DetailParameters>(section);
}

}  // namespace desert_sim
