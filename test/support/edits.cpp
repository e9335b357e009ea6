#include "test/support/edits.hpp"

#include <cmath>

#include "src/core/error.hpp"

namespace desert_sim::test {

using command::EditTerrain;

std::string edit_world(const std::string& boundary, const std::string& more) {
  return "grid: {width: 20, height: 16, cell_size: 0.5, origin_x: 100, origin_y: -50, boundary: " + boundary +
         "}\nterrain: [uniform: {layer: bedrock, value: 30}, uniform: {layer: sand, value: 2}" + more + "]\n";
}

EditTerrain edit_at(int x, int y, BrushShape shape) {
  EditTerrain e;
  e.shape = shape;
  e.x = 100 + 0.5 * (x + 0.5);
  e.y = -50 + 0.5 * (y + 0.5);
  e.value = 1;
  return e;
}

std::vector<EditTerrain> one_of_each_shape() {
  std::vector<EditTerrain> edits;
  for (const char* const& name : brush_shapes) {
    EditTerrain e = edit_at(5, 5, static_cast<BrushShape>(&name - brush_shapes));
    e.radius = 1.9;
    e.radius_y = 1.1;
    e.angle_deg = e.shape == BrushShape::circle ? 0 : 30;
    e.inner = 0.3;
    e.falloff = 0.6;
    if (e.shape == BrushShape::polygon)
      e.points = {{101.1, -49.3}, {104.4, -48.8}, {103.2, -47.1}, {104.7, -45.9}, {101.3, -45.2}};
    if (e.shape == BrushShape::capsule) e.points = {{101.9, -48.3}, {103.7, -46.2}}, e.radius = 1.2;
    if (e.shape == BrushShape::patch) {
      e.patch = {5, 3, {}};
      for (int n = 0; n < 15; ++n) e.patch.values.push_back(0.1f * static_cast<float>((n * 7) % 15));
    }
    edits.push_back(e);
  }
  return edits;
}

EditTerrain shifted(EditTerrain edit, double dx, double dy) {
  edit.x += dx;
  edit.y += dy;
  for (command::Point& p : edit.points) p.x += dx, p.y += dy;
  return edit;
}

EditTerrain quarter_turned(EditTerrain edit, double x, double y) {
  const auto turn = [&](double& px, double& py) {
    const double dx = px - x, dy = py - y;
    px = x - dy;
    py = y + dx;
  };
  turn(edit.x, edit.y);
  for (command::Point& p : edit.points) turn(p.x, p.y);
  edit.angle_deg += 90;
  return edit;
}

std::string refusal(Simulation& simulation, const EditTerrain& edit) {
  const std::uint64_t before = simulation.state().hash();
  std::string reason;
  try {
    simulation.apply(edit);
    ADD_FAILURE() << "was not refused";
  } catch (const ConfigError& error) {
    reason = error.what();
  }
  EXPECT_EQ(before, simulation.state().hash()) << "refused, but changed something: " << reason;
  return reason;
}

}  // namespace desert_sim::test
