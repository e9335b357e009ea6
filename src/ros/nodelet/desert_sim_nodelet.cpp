/// The nodelet desert_sim/DesertSimNodelet: DesertSimServer inside a nodelet manager.
#include <pluginlib/class_list_macros.hpp>

#include "src/ros/node/desert_sim_server.hpp"
#include "src/ros/nodelet/server_nodelet.hpp"

namespace desert_sim {

/// A failure at run time is in ~status, too, and in the answer of every service.
class DesertSimNodelet : public ServerNodelet<DesertSimServer> {
  std::unique_ptr<DesertSimServer> make_server() override {
    return std::make_unique<DesertSimServer>(getPrivateNodeHandle());
  }
};

}  // namespace desert_sim

PLUGINLIB_EXPORT_CLASS(desert_sim::DesertSimNodelet, nodelet::Nodelet)
