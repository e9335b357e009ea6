#include "src/ros/rover/wheel_tracks.hpp"

#include <ros/console.h>

#include <algorithm>

#include "include/desert_sim/client/service_call.hpp"
#include "src/core/elementary.hpp"
#include "src/ros/conversion/messages.hpp"
#include "src/terrain/map_layers.hpp"

namespace desert_sim {

namespace {

constexpr std::size_t most_tracks_waiting = 64;
constexpr double shallowest = 4e-6;  ///< a few quanta of the terrain [m]
constexpr double packed = 0.1;       ///< looseness under a wheel

geometry_msgs::Point point(double x, double y) {
  geometry_msgs::Point p;
  p.x = x;
  p.y = y;
  return p;
}

}  // namespace

WheelTracks::WheelTracks(const RoverSetup& setup)
    : setup_(setup), service_(setup.node.terrain_node + "/edit_terrain") {
  if (setup.node.clock == RoverClock::ros) thread_ = std::thread([this] { work(); });
}

WheelTracks::~WheelTracks() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
    wake_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

void WheelTracks::follow(const Rover& rover, double cell_size) {
  for (int n = 0; n < rover.suspension().wheels(); ++n) {
    const auto i = static_cast<std::size_t>(n);
    const Eigen::Vector3d hub = rover.suspension().hub(n, rover.state());
    std::optional<Mark>& mark = marks_[i];
    const double way = mark ? elementary::hypot(hub.x() - mark->x, hub.y() - mark->y) : 0;
    if (!mark || way > 10 * setup_.node.track_spacing) mark = Mark{hub.x(), hub.y()};  // it was carried there
    if (way < setup_.node.track_spacing) continue;
    const double sunk = rover.state().wheels[i].sunk;
    const EditTerrainRequest request = stroke(*mark, {hub.x(), hub.y()}, sunk, cell_size);
    mark = Mark{hub.x(), hub.y()};
    if (request.value < shallowest) continue;
    if (!thread_.joinable()) {
      send(request);
      continue;
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    if (waiting_.size() >= most_tracks_waiting) waiting_.pop_front();
    waiting_.push_back(request);
    wake_.notify_all();
  }
}

/// It ends a wheel's radius behind the hub, so that a wheel does not sink into its own stroke.
EditTerrainRequest WheelTracks::stroke(const Mark& from, const Mark& to, double sunk,
                                       double cell_size) const {
  const double way = elementary::hypot(to.x - from.x, to.y - from.y), width = setup_.rover.wheel_width;
  const double back = std::min(setup_.rover.wheel_radius / way, 1.0);
  const double bx = (to.x - from.x) * back, by = (to.y - from.y) * back;
  EditTerrainRequest request;
  request.layer = "sand";
  request.shape = "capsule";
  request.merge = "sub";
  request.points = {point(from.x - bx, from.y - by), point(to.x - bx, to.y - by)};
  request.radius = std::max(width / 2, 0.75 * cell_size);
  request.inner = 0.5;  // the mean weight across is 3/4
  request.value = sunk * width / (2 * request.radius * 0.75);
  request.conserve = true;
  request.ring_width = std::max(width, 1.5 * cell_size);
  request.stroke = "tracks of wheels";
  return request;
}

void WheelTracks::send(const EditTerrainRequest& request) {
  EditTerrain exchange;
  exchange.request = request;
  if (!call_service(service_, exchange)) {
    ROS_WARN_THROTTLE(5, "The tracks of the wheels are left out: %s does not answer.", service_.c_str());
    return;
  }
  if (!exchange.response.success) {
    ROS_WARN_THROTTLE(5, "The terrain refused a track: %s", exchange.response.message.c_str());
    return;
  }
  ++taken_;
  if (!find_map_layer("looseness")) return;
  exchange.request.layer = "looseness";
  exchange.request.merge = "min";
  exchange.request.value = packed;
  exchange.request.conserve = false;
  exchange.request.ring_width = 0;
  if (call_service(service_, exchange) && !exchange.response.success)
    ROS_WARN_THROTTLE(60, "The tracks of the wheels are not packed: %s", exchange.response.message.c_str());
}

void WheelTracks::work() {
  const auto pause = std::chrono::duration<double>(1 / setup_.node.track_rate);
  for (;;) {
    std::unique_lock<std::mutex> lock(mutex_);
    wake_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
    if (stopping_) return;
    const EditTerrainRequest request = waiting_.front();
    waiting_.pop_front();
    lock.unlock();
    send(request);
    lock.lock();
    if (wake_.wait_for(lock, pause, [this] { return stopping_; })) return;
  }
}

}  // namespace desert_sim
