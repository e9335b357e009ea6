#pragma once
/// Coordinates that are not in metres.

#include <string>

namespace desert_sim {

/// The command that projects a raster in degrees to metres: to the UTM zone of the given longitude and
/// latitude of its centre [deg], near the poles to the polar stereographic projection.
std::string projecting_command(const std::string& path, double longitude, double latitude);

/// Throws ConfigError that has this command if the unit of the projection's coordinates is known and is not
/// the metre. `x`, `y`: the raster's centre in these coordinates.
void require_metres(const std::string& path, const std::string& wkt, double x, double y);

}  // namespace desert_sim
