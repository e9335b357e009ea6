#pragma once
/// Coordinates in degrees.

#include <string>

namespace desert_sim {

/// Whether a projection (WKT, may be empty) has geographic coordinates.
bool is_geographic(const std::string& wkt);

/// The command that projects a raster in degrees to metres: to the UTM zone of the given longitude and
/// latitude of its centre [deg], near the poles to the polar stereographic projection.
std::string projecting_command(const std::string& path, double longitude, double latitude);

/// Throws ConfigError that has this command if the projection is geographic.
void refuse_degrees(const std::string& path, const std::string& wkt, double longitude, double latitude);

}  // namespace desert_sim
