#pragma once
/// Converts service requests into commands of the simulation. All throw ConfigError that names the field, its
/// value and what is allowed. Ranges are checked by the simulation itself when it applies the command.

#include <desert_sim/EditPlants.h>
#include <desert_sim/EditTerrain.h>
#include <desert_sim/EditWind.h>
#include <desert_sim/SetWeather.h>
#include <desert_sim/SetWind.h>
#include <desert_sim/SetWindSchedule.h>
#include <geometry_msgs/Vector3Stamped.h>

#include "src/core/data_folder.hpp"
#include "src/ros/conversion/terrain_transforms.hpp"
#include "src/simulation/commands/command.hpp"

namespace desert_sim {

command::SetWind wind_command(const SetWindRequest& request);
command::SetWindSchedule wind_schedule_command(const SetWindScheduleRequest& request);
command::EditWind wind_edit_command(const EditWindRequest& request, const TerrainTransforms& frames);
command::SetParameters weather_command(const SetWeatherRequest& request);
/// A message on ~cmd_wind.
/// All messages on ~cmd_wind are one stroke, until somebody undoes it.
constexpr const char* cmd_wind_stroke = "cmd_wind";
command::SetWind cmd_wind_command(const geometry_msgs::Vector3Stamped& message,
                                  const TerrainTransforms& frames);
command::EditPlants plants_command(const EditPlantsRequest& request, const TerrainTransforms& frames);
/// `files`: where rasters lie that the request names.
command::EditTerrain edit_command(const EditTerrainRequest& request, const TerrainTransforms& frames,
                                  const DataFolder& files);

}  // namespace desert_sim
