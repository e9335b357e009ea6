#pragma once
/// Messages of a sender whose numbers and elevations a test chooses.

#include <desert_sim/ElevationGrid.h>
#include <desert_sim/ElevationUpdate.h>

#include <boost/make_shared.hpp>
#include <functional>

namespace client_test {

using desert_sim::ElevationGrid;
using desert_sim::ElevationUpdate;
using desert_sim::LayerTile;

/// A keyframe of any stream without its values: at second `step` of ROS time; cells of 2 m, corner at (10,
/// -20).
template <class Keyframe>
Keyframe empty_keyframe(std::uint32_t number, std::uint32_t step, std::uint32_t width, std::uint32_t height) {
  Keyframe grid;
  grid.header.frame_id = "terrain";
  grid.header.stamp = ros::Time(step, 0);
  grid.keyframe = number;
  grid.step = step;
  grid.sim_time = step;
  grid.width = width;
  grid.height = height;
  grid.cell_size = 2;
  grid.origin.position.x = 10;
  grid.origin.position.y = -20;
  grid.origin.orientation.w = 1;
  return grid;
}

/// An update of any stream, of one tile.
template <class Update>
boost::shared_ptr<Update> update_of(std::uint32_t keyframe, std::uint32_t sequence, std::uint32_t step,
                                    const LayerTile& changed) {
  auto u = boost::make_shared<Update>();
  u->header.frame_id = "terrain";
  u->header.stamp = ros::Time(step, 0);
  u->keyframe = keyframe;
  u->sequence = sequence;
  u->step = step;
  u->sim_time = step;
  u->tiles = {changed};
  return u;
}

inline ElevationGrid keyframe(std::uint32_t number, std::uint32_t step, std::uint32_t width = 130,
                              std::uint32_t height = 70, float elevation = 0) {
  auto grid = empty_keyframe<ElevationGrid>(number, step, width, height);
  grid.elevation.assign(std::size_t{width} * height, elevation);
  return grid;
}

/// Cell (x, y) is elevation(x, y).
inline ElevationGrid keyframe_of(const std::function<double(double, double)>& elevation,
                                 std::uint32_t width = 130, std::uint32_t height = 70) {
  ElevationGrid grid = keyframe(1, 1, width, height);
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x)
      grid.elevation[y * width + x] = static_cast<float>(elevation(x, y));
  return grid;
}

inline LayerTile tile(std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height,
                      float elevation) {
  LayerTile t;
  t.x = x;
  t.y = y;
  t.width = width;
  t.height = height;
  t.data.assign(std::size_t{width} * height, elevation);
  return t;
}

/// Writes `elevation` on cells (0…1, 0…2).
inline ElevationUpdate::Ptr update(std::uint32_t keyframe, std::uint32_t sequence, std::uint32_t step,
                                   float elevation = 1) {
  return update_of<ElevationUpdate>(keyframe, sequence, step, tile(0, 0, 2, 3, elevation));
}

}  // namespace client_test
