#include "src/tools/bench_scenes.hpp"

#include <sstream>

#include "src/scenario/scenario_file.hpp"

namespace desert_sim {

bool is_bench_scene(const std::string& name) {
  return name == "A" || name == "B" || name == "mature" || name == "edited";
}

int default_warm_up_steps(const std::string& scene) {
  return scene == "mature" || scene == "edited" ? mature_steps : 0;
}

Scenario bench_scenario(const std::string& scene, int size, const Settings& settings) {
  if (!is_bench_scene(scene)) {
    Settings all = settings;
    all.push_back("grid.width=" + std::to_string(size));
    all.push_back("grid.height=" + std::to_string(size));
    return load_scenario(scenario_argument(scene), all);
  }
  const bool thick = scene == "B";
  std::ostringstream text;
  text.precision(17);
  text << "grid: {width: " << size << ", height: " << size << ", cell_size: " << bench_extent / size << "}\n"
       << "terrain:\n  - noise: {layer: sand, low: " << (thick ? 3.0 : 0.5)
       << ", high: " << (thick ? 5.0 : 2.0) << "}\n"
       << "wind: {speed: " << (thick ? 3 : 5) << ", direction_deg: 0}\n";
  // `edited` has the name of `mature`, so that a checkpoint of one is a start of the other.
  return parse_scenario_text(text.str(), scene == "edited" ? "mature" : scene, settings);
}

command::EditTerrain bench_edit(const GridParameters& grid) {
  command::EditTerrain column;
  column.layer = "sand";
  column.shape = BrushShape::circle;
  column.merge = BrushMerge::add;
  column.x = grid.origin_x + 0.5 * grid.width * grid.cell_size;
  column.y = grid.origin_y + 0.5 * grid.height * grid.cell_size;
  column.radius = 20;
  column.inner = 1;
  column.value = 50;
  return column;
}

}  // namespace desert_sim
