/// The nodelet desert_sim/DesertRoverNodelet: RoverServer inside a nodelet manager.
#include <nodelet/nodelet.h>
#include <ros/wall_timer.h>

#include <memory>
#include <pluginlib/class_list_macros.hpp>
#include <string>

#include "src/ros/rover/rover_server.hpp"

namespace desert_sim {

/// Input that is refused makes loading fail. A failure at run time is in the log and on /diagnostics; the
/// manager and its other nodelets continue.
class DesertRoverNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      server_ = std::make_unique<RoverServer>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const std::exception& e) {
      NODELET_FATAL("%s", e.what());
      throw;  // the loader turns it into the answer that nothing was loaded
    }
    watch_ = getPrivateNodeHandle().createWallTimer(ros::WallDuration(0.1),
                                                    [this](const ros::WallTimerEvent&) { watch(); });
  }

  void watch() {
    const std::string failure = server_->failure();
    if (failure.empty()) return;
    NODELET_FATAL("%s", failure.c_str());
    watch_.stop();
  }

  std::unique_ptr<RoverServer> server_;
  ros::WallTimer watch_;
};

}  // namespace desert_sim

PLUGINLIB_EXPORT_CLASS(desert_sim::DesertRoverNodelet, nodelet::Nodelet)
