#pragma once
/// The parameters that can change live as messages of dynamic_reconfigure. There is a group for each section
/// of the scenario, with the names SECTION__KEY; the group `publishers`, with the names of the private
/// parameters; and step_rate. Numbers and switches keep their types; choices, lists ("[1, 2]") and integers
/// of more than 32 bits are texts.

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>

#include "src/ros/topics/publisher_parameters.hpp"
#include "src/scenario/scenario.hpp"

namespace desert_sim {

struct LiveParameters {
  Scenario scenario;
  PublisherSetup publishers;
  double step_rate = 0;  ///< [steps/s]
};

/// What a request changes: `settings` of the scenario, and the other parameters as they are to be.
struct LiveChange {
  Settings settings;
  PublisherSetup publishers;
  double step_rate = 0;
};

/// The units, ranges, choices and docs of the parameter tables; `defaults` gives the default values.
dynamic_reconfigure::ConfigDescription reconfigure_description(const LiveParameters& defaults);
/// Why `step_rate` has no effect under these parameters; empty if it has.
std::string ineffective_rate(double step_rate, const RunParameters& run);
dynamic_reconfigure::Config reconfigure_values(const LiveParameters& present);
/// Throws ConfigError for a name that is unknown, and for a value that is refused, such as a step_rate
/// beside a run.acceleration that makes it ineffective. The values of the scenario are only checked when the
/// command SetParameters is applied.
LiveChange reconfigure_change(const dynamic_reconfigure::Config& request, const LiveParameters& present);

}  // namespace desert_sim
