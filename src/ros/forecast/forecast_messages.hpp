#pragma once
/// Forecasts as messages.

#include <desert_sim/Forecast.h>
#include <nav_msgs/OccupancyGrid.h>

#include <string>

#include "src/ros/simulation/terrain_state.hpp"

namespace desert_sim {

/// `start`: of the state that it begins with. The maps move from the forecast to the message.
ForecastPtr forecast_message(ForecastMaps&& forecast, const Moment& start, const std::string& frame);

}  // namespace desert_sim
