#pragma once
/// Tracks: each wheel presses the sand that it rolls over to its sinkage, and displaces it to both sides,
/// by strokes of the simulation's brush that conserve the sand. Where the terrain has the layer looseness,
/// the track is packed.
///
/// A cell is mostly wider than a wheel. The stroke is as wide as the brush needs to meet cells, and as much
/// shallower, so that it displaces the volume of the wheel's track.

#include <desert_sim/EditTerrain.h>
#include <ros/node_handle.h>

#include <array>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>

#include "src/ros/rover/rover_node_parameters.hpp"
#include "src/rover/rover.hpp"

namespace desert_sim {

class WheelTracks {
 public:
  explicit WheelTracks(const RoverSetup& setup);
  /// Waits for a call that is under way.
  ~WheelTracks();
  WheelTracks(const WheelTracks&) = delete;
  WheelTracks& operator=(const WheelTracks&) = delete;

  /// Notes where the wheels are; a way of ~track_spacing becomes a stroke. In lockstep returns when the
  /// terrain has taken the strokes; otherwise a thread brings them, one at a time, and those that wait too
  /// long are left out.
  void follow(const Rover& rover, double cell_size);
  /// Strokes that the terrain has taken.
  std::uint64_t taken() const { return taken_; }

 private:
  struct Mark {
    double x = 0, y = 0;
  };
  EditTerrainRequest stroke(const Mark& from, const Mark& to, double sunk, double cell_size) const;
  void send(const EditTerrainRequest& request);
  void work();

  const RoverSetup setup_;
  const std::string service_;
  std::array<std::optional<Mark>, most_wheels> marks_;
  std::atomic<std::uint64_t> taken_{0};
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<EditTerrainRequest> waiting_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace desert_sim
