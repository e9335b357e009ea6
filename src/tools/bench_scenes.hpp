#pragma once
/// The scenes that desert_bench times. Each built-in scene is 1024 m square, whatever its number of cells,
/// with white-noise sand on flat rock.
///
///   A       sand 0.5 … 2 m, wind 5 m/s: barchans
///   B       sand 3 … 5 m, wind 3 m/s: transverse dunes
///   mature  A after 2000 steps: dunes with slip faces, and bare rock between them
///   edited  mature, with a column of sand, 50 m high and 20 m in radius, added in its middle by the command
///           edit_terrain just before the timed steps

#include <memory>
#include <string>

#include "src/simulation/session.hpp"

namespace desert_sim {

constexpr double bench_extent = 1024;  ///< [m]
constexpr int mature_steps = 2000;

bool is_bench_scene(const std::string& name);
/// Default number of steps before the timed ones.
int default_warm_up_steps(const std::string& scene);
/// The scene with this name, or the scenario in this file, with `size` × `size` cells. Throws ConfigError.
Scenario bench_scenario(const std::string& scene, int size, const Settings& settings);
/// The command that adds the column of sand in the scene `edited`.
command::EditTerrain bench_edit(const GridParameters& grid);

}  // namespace desert_sim
