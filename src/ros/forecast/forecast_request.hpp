#pragma once
/// Goals of ~forecast as options of a run ahead.

#include <desert_sim/ForecastTerrainGoal.h>

#include "src/ros/parameters/reconfigure_messages.hpp"
#include "src/simulation/forecast/forecast.hpp"

namespace desert_sim {

/// `step_rate` as in ForecastOptions. Throws ConfigError that names the field, its value and what is allowed:
/// for all that the services would refuse of wind and parameters, and for all of the rest that the present
/// parameters tell.
ForecastOptions forecast_options(const ForecastTerrainGoal& goal, const LiveParameters& present,
                                 double step_rate);

}  // namespace desert_sim
