#pragma once
/// A nodelet that holds a server, an object with threads of its own.

#include <nodelet/nodelet.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <exception>
#include <memory>
#include <string>

namespace desert_sim {

/// Input that is refused makes loading fail. A failure at run time, which Server::failure() tells, is logged
/// once; the manager and its other nodelets continue.
template <class Server>
class ServerNodelet : public nodelet::Nodelet {
 private:
  virtual std::unique_ptr<Server> make_server() = 0;

  void onInit() override {
    try {
      server_ = make_server();
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

  std::unique_ptr<Server> server_;
  ros::WallTimer watch_;
};

}  // namespace desert_sim
