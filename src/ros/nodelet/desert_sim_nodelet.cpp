/// The nodelet desert_sim/DesertSimNodelet: DesertSimServer inside a nodelet manager.
#include <nodelet/nodelet.h>
#include <ros/wall_timer.h>

#include <memory>
#include <pluginlib/class_list_macros.hpp>
#include <string>

#include "src/core/error.hpp"
#include "src/ros/node/desert_sim_server.hpp"

namespace desert_sim {

/// Input that is refused makes loading fail. A failure at run time is in the log, in ~status, and in the
/// answer of every service; the manager and its other nodelets continue.
class DesertSimNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      server_ = std::make_unique<DesertSimServer>(getPrivateNodeHandle());
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

  std::unique_ptr<DesertSimServer> server_;
  ros::WallTimer watch_;
};

}  // namespace desert_sim

PLUGINLIB_EXPORT_CLASS(desert_sim::DesertSimNodelet, nodelet::Nodelet)
