#pragma once
/// A map of costs as messages tell it, whatever they say: without OGRE.

#include <map_msgs/OccupancyGridUpdate.h>
#include <nav_msgs/OccupancyGrid.h>
#include <ros/node_handle.h>
#include <tf2/LinearMath/Transform.h>

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "src/render/cells.hpp"

namespace desert_sim {

struct CostMap {
  static constexpr std::uint32_t most_cells = 8192;  ///< on a side: what graphics cards have textures for

  std::string frame;
  tf2::Transform corner;  ///< the south-west one in that frame; x to the map's east
  double cell_size = 1;   ///< [m]
  int width = 0, height = 0;
  std::vector<std::int8_t> costs;  ///< row by row from the south-west

  CostMap() = default;
  /// Throws ConfigError for sizes and places that no map of a desert has, and that do not fit together.
  explicit CostMap(const nav_msgs::OccupancyGrid& message);
  /// Throws ConfigError for cells that the map does not have. Returns those that have changed.
  render::CellRectangle update(const map_msgs::OccupancyGridUpdate& message);

  render::CellRectangle all() const { return {0, 0, width, height}; }
  std::int8_t at(int x, int y) const {
    return costs[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

/// The newest map of a topic, with the updates of <topic>_updates in it: received on rviz's threads for slow
/// work and handed over to its frames.
class CostMapInbox {
 public:
  CostMapInbox() = default;
  ~CostMapInbox() { unsubscribe(); }
  CostMapInbox(const CostMapInbox&) = delete;
  CostMapInbox& operator=(const CostMapInbox&) = delete;

  /// `node` has the callback queue; see rviz::Display::threaded_nh_.
  void subscribe(ros::NodeHandle& node, const std::string& topic);
  void unsubscribe();
  bool subscribed() const { return static_cast<bool>(maps_); }
  bool connected() const { return maps_.getNumPublishers() > 0; }

  struct Report {
    std::uint64_t maps = 0, updates = 0;
    std::string problem;  ///< of the last message that was refused, until a whole map comes
  };
  Report report() const;

  /// Calls visit(map, the cells that have changed since the last call, whether it is another grid), if there
  /// is a map and a change. No message is taken meanwhile.
  using Visit = std::function<void(const CostMap& map, const render::CellRectangle& changed, bool replaced)>;
  void take(const Visit& visit);

 private:
  void receive(const nav_msgs::OccupancyGrid& message);
  void receive(const map_msgs::OccupancyGridUpdate& message);

  ros::Subscriber maps_, updates_;
  mutable std::mutex mutex_;  ///< protects all that follows
  CostMap map_;
  render::CellRectangle changed_;
  bool replaced_ = false;
  Report report_;
};

}  // namespace desert_sim
