#pragma once
/// The scenes that desert_bench times. All but scenarios of one's own are 1024 m square, whatever their size
/// in cells, with sand of white noise on flat rock.
///
///   A       sand 0.5 … 2 m, wind 5 m/s: barchans
///   B       sand 3 … 5 m, wind 3 m/s: transverse dunes
///   mature  A after 2000 steps: dunes with slip faces, sand in some places only
///   edited  mature, and a column of sand, 50 m high and 20 m in radius, dropped into its middle by the
///   command
///           that users have, right before the steps that are timed

#include <memory>
#include <string>

#include "src/simulation/session.hpp"

namespace desert_sim {

constexpr double bench_extent = 1024;  ///< [m]
constexpr int mature_steps = 2000;

bool is_bench_scene(const std::string& name);
/// Steps before the ones that are timed, unless somebody says else.
int warm_up_of(const std::string& scene);
/// A scene by name, or a scenario's file with `size` × `size` cells. Throws ConfigError.
Scenario bench_scenario(const std::string& scene, int size, const Settings& settings);
/// The command of the scene `edited`.
command::EditTerrain bench_edit(const GridParameters& grid);

}  // namespace desert_sim
