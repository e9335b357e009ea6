#pragma once
/// A publisher of keyframes and updates of terrains that a test makes up.

#include <desert_sim/ElevationGrid.h>
#include <desert_sim/ElevationUpdate.h>
#include <ros/node_handle.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <functional>
#include <string>

namespace rviz_test {

using Height = std::function<float(int x, int y)>;

inline float dunes(int x, int y) {
  return 4 * std::sin(0.09f * static_cast<float>(x)) + 3 * std::cos(0.06f * static_cast<float>(y));
}

class MadeUpNode {
 public:
  /// `name` begins with a slash. Nothing is published yet. Cells are 1 m.
  explicit MadeUpNode(const std::string& name, std::string frame = "map") : frame_(std::move(frame)) {
    keyframes_ = node_.advertise<desert_sim::ElevationGrid>(name + "/elevation", 1, true);
    updates_ = node_.advertise<desert_sim::ElevationUpdate>(name + "/elevation_updates", 1000);
  }

  void keyframe(int width, int height, const Height& elevation, double cell_size = 1) {
    auto grid = boost::make_shared<desert_sim::ElevationGrid>();
    fill(*grid);
    grid->keyframe = ++keyframe_;
    sequence_ = 0;
    grid->width = static_cast<std::uint32_t>(width);
    grid->height = static_cast<std::uint32_t>(height);
    grid->cell_size = cell_size;
    grid->origin.orientation.w = 1;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) grid->elevation.push_back(elevation(x, y));
    keyframes_.publish(boost::shared_ptr<const desert_sim::ElevationGrid>(grid));
  }

  /// One tile of new elevations.
  void update(int x0, int y0, int width, int height, const Height& elevation) {
    auto update = boost::make_shared<desert_sim::ElevationUpdate>();
    fill(*update);
    update->keyframe = keyframe_;
    update->sequence = ++sequence_;
    update->tiles.resize(1);
    auto& tile = update->tiles.front();
    tile.x = static_cast<std::uint32_t>(x0);
    tile.y = static_cast<std::uint32_t>(y0);
    tile.width = static_cast<std::uint32_t>(width);
    tile.height = static_cast<std::uint32_t>(height);
    for (int y = y0; y < y0 + height; ++y)
      for (int x = x0; x < x0 + width; ++x) tile.data.push_back(elevation(x, y));
    updates_.publish(boost::shared_ptr<const desert_sim::ElevationUpdate>(update));
  }

  bool has_subscribers() const {
    return keyframes_.getNumSubscribers() > 0 && updates_.getNumSubscribers() > 0;
  }
  void end() {
    keyframes_.shutdown();
    updates_.shutdown();
  }

 private:
  template <class Message>
  void fill(Message& message) {
    message.header.frame_id = frame_;
    message.header.stamp = ros::Time::now();
    message.step = ++step_;
    message.sim_time = static_cast<double>(step_);
  }

  const std::string frame_;
  ros::NodeHandle node_;
  ros::Publisher keyframes_, updates_;
  std::uint32_t keyframe_ = 0, sequence_ = 0;
  std::uint64_t step_ = 0;
};

}  // namespace rviz_test
