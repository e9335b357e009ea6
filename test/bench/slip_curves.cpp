/// Prints slip, drift and sinkage of the rover classes by slope and looseness, as CSV: the laws of
/// wheel_ground.hpp. test/bench/slip_curves.py plots them.
#include <cstdio>

#include "kernels/rover/wheel_ground.hpp"
#include "src/scenario/rover_presets.hpp"
#include "src/scenario/scenario.hpp"

int main() {
  using namespace desert_sim;
  constexpr float degree = 0.0174532925f;
  std::printf("rover,looseness,slope_deg,slip,drift,sinkage_m,wheel_radius_m\n");
  for (const std::string& name : rover_presets()) {
    const Scenario s = parse_scenario_text("rover: " + name + "\n", name);
    const wheels::WheelGround law =
        wheels::make_wheel_ground(s.get<TraversabilityParameters>(), s.get<WheelGroundParameters>());
    for (const float looseness : {0.0f, 0.3f, 0.6f, 1.0f})
      for (int half = -40; half <= 60; ++half) {
        const wheels::Ground ground{looseness, 1.0f, 0.0f};
        const float deg = 0.5f * static_cast<float>(half);
        const float slip =
            law.longitudinal_slip(deg * degree, s.get<TraversabilityParameters>().drive_speed, ground);
        std::printf("%s,%.1f,%.1f,%.5f,%.5f,%.5f,%.3f\n", name.c_str(), static_cast<double>(looseness),
                    static_cast<double>(deg), static_cast<double>(slip),
                    static_cast<double>(law.lateral_slip(deg * degree, ground)),
                    static_cast<double>(law.sinkage(slip, 1.0f, ground)), static_cast<double>(law.radius));
      }
  }
}
