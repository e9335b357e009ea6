#pragma once
/// Ripples on the ground near the camera: a texture of the ground's material that follows ~micro_relief.
/// Farther away it is averaged to nothing. The alpha of the ground's vertices says how much of it is seen,
/// 0…1.

#include <OgreMaterial.h>
#include <OgreTexture.h>
#include <desert_sim/MicroReliefState.h>

#include <future>
#include <string>

#include "src/rviz/ripple_tile.hpp"
#include "src/rviz/topic_inbox.hpp"

namespace desert_sim {

class RipplesView {
 public:
  /// `ground`: the material of that ground, without textures yet.
  explicit RipplesView(const Ogre::MaterialPtr& ground);
  ~RipplesView();
  RipplesView(const RipplesView&) = delete;
  RipplesView& operator=(const RipplesView&) = delete;

  /// The ripples of this topic from now on; none for an empty name.
  void subscribe(ros::NodeHandle& node, const std::string& topic);
  /// Takes over what a thread of its own has drawn. Call it in each frame.
  void update();
  /// Of the ripples that are shown, or about to be [m]; 0: none.
  double wavelength() const { return drawn_ ? static_cast<double>(drawn_->ripple_wavelength) : 0; }

 private:
  void show(const RippleTile& tile);

  TopicInbox<MicroReliefState> inbox_;
  MicroReliefState::ConstPtr drawn_;  ///< the state of the tile that is shown, or being drawn
  std::future<RippleTile> tile_;
  const Ogre::MaterialPtr ground_;
  const Ogre::TexturePtr texture_;
  Ogre::TextureUnitState* light_ = nullptr;
};

}  // namespace desert_sim
