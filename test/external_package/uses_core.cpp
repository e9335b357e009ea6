/// Exit status 0 if a small desert makes three steps and loses nothing.
#include <desert_sim/simulation/session.hpp>

int main() {
  const desert_sim::Scenario scenario = desert_sim::parse_scenario_text(
      "{grid: {width: 32, height: 32}, terrain: [uniform: {layer: sand, value: 1}]}", "text");
  desert_sim::Session session(scenario, desert_sim::refuse_rasters, "cpu", 1);
  for (int n = 0; n < 3; ++n) session.step();
  return session.simulation().steps() == 3 ? 0 : 1;
}
