#pragma once
/// Local features of the wind as YAML, with the paths along which they move, and what must hold of them.

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "kernels/wind/wind_features.hpp"
#include "src/core/validation_errors.hpp"

namespace desert_sim {

constexpr std::size_t max_wind_path = 256;  ///< points

void read_wind_path(const YAML::Node& list, const std::string& key, ValidationErrors& errors,
                    std::vector<WindPathPoint>& path);
void read_wind_features(const YAML::Node& list, const std::string& key, ValidationErrors& errors,
                        std::vector<WindFeature>& features);

/// Writes the entries of an open map; a feature without a path has no such entry.
void emit_wind_feature(YAML::Emitter& out, const WindFeature& feature);
/// Writes the list as an entry of an open map.
void emit_wind_features(YAML::Emitter& out, const std::vector<WindFeature>& features);

/// What involves more than one number: `prefix` goes before the keys of errors.
void check_wind_feature(const WindFeature& feature, const std::string& prefix, ValidationErrors& errors);

}  // namespace desert_sim
