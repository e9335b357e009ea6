#include "test/support/settings.hpp"

namespace desert_sim::test {

std::string RandomSettings::setting() {
  const std::string number = std::to_string(between(0, 1)), time = std::to_string(between(100, 900));
  const std::string all[] = {"saltation.lift=" + number,
                             "abrasion.rate=" + number,
                             "wind.speed=" + std::to_string(between(1, 9)),
                             "wind.radii=[" + std::to_string(between(40, 90)) + "]",
                             "run.acceleration=" + number,
                             "run.timeline=[{time: " + time + ", set: {saltation.lift: " + number + "}}]",
                             "echo_dunes.enabled=" + std::string(below(2) ? "true" : "false"),
                             "soil.enabled=true",
                             "moisture.enabled=true",
                             "water.enabled=true",
                             "rain.rate=1e-5",
                             "water.springs=[{x: 110, y: -40, radius: 2, discharge: " + number + "}]",
                             "species.0.max_radius=" + number,
                             "species.2={preset: palm}",
                             "competition=[[1, " + number + "], [2, 1]]",
                             "growth_curves.grass=[[-1, -" + number + "], [1, " + number + "]]",
                             "appearance.sand=[" + number + ", 0.5, 0.25]"};
  return all[below(std::size(all))];
}

Command RandomSettings::next(const std::string& stroke) {
  const std::size_t kind = below(7);
  if (kind == 0) return command::SetWind{between(-180, 180), between(0, 12), between(0, 3), stroke};
  if (kind == 1) {
    command::SetWindSchedule schedule;
    schedule.stroke = stroke;
    schedule.regime.regime = below(2) ? WindRegimeKind::rose : WindRegimeKind::timeline;
    schedule.regime.hold_time = between(0.5f, 3);
    schedule.regime.rose_seed = below(99);
    for (int n = 0; n < 4; ++n)
      schedule.regime.segments.push_back(
          {between(-180, 180), between(1, 9), between(1, 4), between(0, 1), 1});
    return schedule;
  }
  if (kind == 2 || kind == 3) {
    command::EditWind edit;
    edit.stroke = stroke;
    const std::size_t operation = below(8);
    edit.operation = operation < 4   ? WindEdit::add
                     : operation < 6 ? WindEdit::change
                     : operation < 7 ? WindEdit::remove
                                     : WindEdit::clear;
    edit.feature.id = static_cast<int>(1 + below(4));
    edit.feature.kind = static_cast<WindFeatureKind>(below(4));
    edit.feature.x = between(100, 120);
    edit.feature.y = between(-50, -35);
    edit.feature.radius = between(1, 9);
    edit.feature.speed = between(0, 5);
    if (below(3) == 0) edit.feature.path = {{1, 100, -50}, {4, 110, -40}, {9, 105, -45}};
    return edit;
  }
  command::SetParameters parameters;
  parameters.stroke = stroke;
  for (std::size_t n = 1 + below(2); n > 0; --n) parameters.settings.push_back(setting());
  if (below(3) == 0) parameters.ramp = between(0, 9);
  return parameters;
}

}  // namespace desert_sim::test
