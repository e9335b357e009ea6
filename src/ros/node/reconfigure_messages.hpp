#pragma once
/// What of a node can change live, as dynamic_reconfigure's messages: a group a section of the scenario, with
/// names SECTION__KEY; the group `publishers`, whose names are those of the private parameters; and
/// step_rate. Numbers and switches are what they are; choices, lists ("[1, 2]") and whole numbers beyond 32
/// bits are texts.

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

/// What a request changes: `settings` of the scenario, and the rest as it is to be.
struct LiveChange {
  Settings settings;
  PublisherSetup publishers;
  double step_rate = 0;
};

/// Units, ranges, choices and docs from the parameter tables; `defaults` gives the default values.
dynamic_reconfigure::ConfigDescription reconfigure_description(const LiveParameters& defaults);
dynamic_reconfigure::Config reconfigure_values(const LiveParameters& present);
/// Throws ConfigError for a name that is none of theirs, and for a value that is refused, of all but the
/// scenario's, which are checked when the command SetParameters is applied.
LiveChange reconfigure_change(const dynamic_reconfigure::Config& request, const LiveParameters& present);

}  // namespace desert_sim
