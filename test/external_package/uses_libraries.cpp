/// Exit status 0 if this program sees the build as the library does, a small desert makes three steps, and a
/// client takes a keyframe. With a master it also waits for a node's terrain: any argument.
#include <ros/ros.h>

#include <desert_sim/client/terrain_client.hpp>
#include <desert_sim/simulation/session.hpp>
#include <string>
#include <type_traits>

// test/CMakeLists.txt says what the library was built with; here it must come from its headers alone.
#ifndef DESERT_WITH_CUDA
#error "an undefined name counts as 0: with_backend() would take every backend for the CPU's"
#endif
static_assert(DESERT_WITH_CUDA == EXPECTED_WITH_CUDA);

bool runs_a_desert() {
  const desert_sim::Scenario scenario = desert_sim::parse_scenario_text(
      "{grid: {width: 32, height: 32}, terrain: [uniform: {layer: sand, value: 1}]}", "text");
  desert_sim::Session session(scenario, desert_sim::no_raster_loader, "auto", 1);
  for (int n = 0; n < 3; ++n) session.step();
  if (session.simulation().steps() != 3) return false;
  desert_sim::Exec& exec = session.simulation().exec();
  const bool as_cpu = desert_sim::with_backend(exec, [](auto& backend) {
    return std::is_same_v<std::decay_t<decltype(backend)>, desert_sim::CpuExec>;
  });
  return as_cpu == (exec.backend() == std::string("cpu"));
}

bool takes_a_keyframe() {
  const desert_sim::ElevationGrid::Ptr keyframe(new desert_sim::ElevationGrid);
  keyframe->width = keyframe->height = 1;
  keyframe->cell_size = keyframe->origin.orientation.w = 1;
  keyframe->elevation = {7};
  desert_sim::ElevationAssembler assembler;
  assembler.process(keyframe);
  return assembler.map()->elevation(0.5, 0.5) == 7;
}

int main(int argc, char** argv) {
  if (!runs_a_desert() || !takes_a_keyframe()) return 1;
  if (argc == 1) return 0;
  ros::init(argc, argv, "uses_libraries");
  const desert_sim::TerrainClient terrain;
  return terrain.wait_for_terrain(10) ? 0 : 1;
}
