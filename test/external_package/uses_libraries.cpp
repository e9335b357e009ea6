/// Exit status 0 if a client takes a keyframe. With a master it also waits for a node's terrain: any
/// argument.
#include <ros/ros.h>

#include <desert_sim/client/terrain_client.hpp>

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
  if (!takes_a_keyframe()) return 1;
  if (argc == 1) return 0;
  ros::init(argc, argv, "uses_libraries");
  const desert_sim::TerrainClient terrain;
  return terrain.wait_for_terrain(10) ? 0 : 1;
}
