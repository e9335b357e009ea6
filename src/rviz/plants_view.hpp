#pragma once
/// The plants of ~plants in OGRE's scene: shapes where they are near, a picture on the ground everywhere.

#include <OgreMaterial.h>
#include <desert_sim/Plants.h>

#include <future>
#include <memory>
#include <string>
#include <vector>

#include "src/render/plant_choice.hpp"
#include "src/rviz/cover_texture.hpp"
#include "src/rviz/plant_objects.hpp"
#include "src/rviz/topic_inbox.hpp"

namespace desert_sim {

class PlantsView {
 public:
  /// Below `parent`, which must outlive it, and whose origin is the corner of the terrain. `ground`: the
  /// material with which that terrain is drawn.
  PlantsView(Ogre::SceneNode* parent, const Ogre::MaterialPtr& ground);

  /// Shows the plants of this topic from now on; none for an empty name.
  void subscribe(ros::NodeHandle& node, const std::string& topic);

  struct Settings {
    double corner_x = 0, corner_y = 0;            ///< of the terrain, in its frame [m]
    double width = 0, height = 0, cell_size = 1;  ///< of the terrain [m]
    double exaggeration = 1;
    std::size_t most = 0;  ///< plants as shapes
    double seconds = 0;    ///< what a frame may take
  };
  /// Takes over what a thread of its own has made of messages. Call it in each frame.
  void update(const Ogre::Camera& camera, int viewport_height, const Settings& settings);

  std::size_t shown() const;    ///< plants that are drawn as shapes
  std::size_t total() const;    ///< plants that there are
  std::size_t waiting() const;  ///< parts of the newest plants that are not shown yet

 private:
  /// What is made of a message.
  struct Prepared {
    std::uint64_t subscription = 0;
    double east = 0, north = 0;  ///< where the plants' origin lies, from the terrain's corner [m]
    std::shared_ptr<const render::PlantTiles> plants;
    std::shared_ptr<const render::CoverPicture> cover;
  };
  void prepare(const Settings& settings);
  bool take_prepared();
  void replace();
  void free_old();
  void clear();

  TopicInbox<Plants> inbox_;
  std::uint64_t subscription_ = 0;  ///< how many there were; what is made for an older one is not shown
  std::future<Prepared> preparing_;
  std::vector<std::shared_ptr<const void>> old_;  ///< that is no longer drawn
  std::future<void> freeing_;
  Ogre::SceneNode* const parent_;
  CoverTexture cover_;
  std::shared_ptr<const render::CoverPicture> picture_;  ///< that it was given last
  std::unique_ptr<PlantObjects> shown_, next_;           ///< next_: not complete, and thus not shown yet
};

}  // namespace desert_sim
