/// The nodelet desert_sim/DesertRoverNodelet: RoverServer inside a nodelet manager.
#include <pluginlib/class_list_macros.hpp>

#include "src/ros/nodelet/server_nodelet.hpp"
#include "src/ros/rover/rover_server.hpp"

namespace desert_sim {

/// A failure at run time is on /diagnostics, too.
class DesertRoverNodelet : public ServerNodelet<RoverServer> {
  std::unique_ptr<RoverServer> make_server() override {
    return std::make_unique<RoverServer>(getNodeHandle(), getPrivateNodeHandle());
  }
};

}  // namespace desert_sim

PLUGINLIB_EXPORT_CLASS(desert_sim::DesertRoverNodelet, nodelet::Nodelet)
