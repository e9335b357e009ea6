/// Exit status 0 if this program sees the build as the library does, and a small desert makes three steps.
#include <desert_sim/simulation/session.hpp>
#include <string>
#include <type_traits>

// test/CMakeLists.txt says what the library was built with; here it must come from its headers alone.
#ifndef DESERT_WITH_CUDA
#error "an undefined name counts as 0: with_backend() would take every backend for the CPU's"
#endif
static_assert(DESERT_WITH_CUDA == EXPECTED_WITH_CUDA);

int main() {
  const desert_sim::Scenario scenario = desert_sim::parse_scenario_text(
      "{grid: {width: 32, height: 32}, terrain: [uniform: {layer: sand, value: 1}]}", "text");
  desert_sim::Session session(scenario, desert_sim::no_raster_loader, "auto", 1);
  for (int n = 0; n < 3; ++n) session.step();
  if (session.simulation().steps() != 3) return 1;
  desert_sim::Exec& exec = session.simulation().exec();
  const bool as_cpu = desert_sim::with_backend(exec, [](auto& backend) {
    return std::is_same_v<std::decay_t<decltype(backend)>, desert_sim::CpuExec>;
  });
  return as_cpu == (exec.backend() == std::string("cpu")) ? 0 : 1;
}
