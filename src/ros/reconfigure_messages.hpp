#pragma once
/// The parameters of a scenario that can change live, as dynamic_reconfigure's messages: a group a section,
/// and names SECTION__KEY; and step_rate, which is the node's. Numbers and switches are what they are;
/// choices, lists ("[1, 2]") and whole numbers beyond 32 bits are texts.

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>

#include "desert_sim/scenario/scenario.hpp"

namespace desert_sim {

/// Units, ranges, choices and docs from the parameter tables; `defaults` gives the default values.
dynamic_reconfigure::ConfigDescription reconfigure_description(const Scenario& defaults, double step_rate);
dynamic_reconfigure::Config reconfigure_values(const Scenario& scenario, double step_rate);
/// The step rate that `request` has, or `present`. Throws ConfigError if it is not in its range.
double reconfigure_step_rate(const dynamic_reconfigure::Config& request, double present);
/// What else `request` would change, as settings for command::SetParameters. Throws ConfigError for a name
/// that is none of theirs; values are checked when the command is applied.
Settings reconfigure_settings(const dynamic_reconfigure::Config& request, const Scenario& present);

}  // namespace desert_sim
