#pragma once
/// Ripples and heaps as shapes on the ground near the camera: a window of fine ground around what the view
/// looks at, which the node works out as for wheels and beams (`~get_submap` with a resolution). It is asked
/// for when the view comes near or moves on, and anew while the terrain changes.

#include <desert_sim/GetSubmap.h>

#include <future>
#include <string>

#include "src/render/near_ground.hpp"
#include "src/rviz/map_windows.hpp"
#include "src/rviz/service_caller.hpp"
#include "src/rviz/terrain_scene.hpp"

namespace desert_sim {

class NearGroundView {
 public:
  explicit NearGroundView(TerrainScene& scene) : scene_(scene) {}
  NearGroundView(const NearGroundView&) = delete;
  NearGroundView& operator=(const NearGroundView&) = delete;

  /// Asks this node from now on; nobody for an empty name, and shows none.
  void follow(const std::string& node);
  /// There is another terrain: drops what is shown, and what is on its way.
  void forget();
  /// Asks anew: the ground is to look different.
  void touch() { asked_ = {}; }
  /// Shows what has come, and asks for what the camera sees now. Call it in each frame. `maps`: those of the
  /// scene's window; `pixels`: the size of what is to be told apart.
  void update(const Ogre::Camera& camera, int viewport_height, const LayerMaps& maps, double pixels,
              double ripple_wavelength);
  /// Why there is none, or what there is; empty if none is wanted here.
  const std::string& status() const { return status_; }
  bool failed() const { return failed_; }

 private:
  /// What was asked for: fine ground of a window at a step.
  struct Question {
    render::NearWindow window;
    std::uint64_t step = 0;
  };
  struct Answer {
    render::NearWindow window;
    render::Mesh mesh;
  };

  void show_answer();
  bool worth_asking(const Question& question) const;
  void ask(const Question& question, const LayerMap& elevation);
  void take(const render::NearWindow& window, const CallOutcome& outcome, const GetSubmapResponse& response);
  void hide();

  TerrainScene& scene_;
  std::string node_, status_;
  bool failed_ = false, shown_ = false;
  bool under_way_ = false;  ///< a call, or its mesh
  Question asked_;
  double time_ = 0;  ///< when it was asked for [s]
  std::future<Answer> answer_;
  ServiceCaller caller_;  ///< the last member: its answers use the others
};

}  // namespace desert_sim
