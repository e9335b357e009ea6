#include "src/rviz/plant_objects.hpp"

#include <OgreSceneManager.h>
#include <OgreSceneNode.h>

#include <algorithm>
#include <utility>

#include "src/render/plant_shapes.hpp"
#include "src/render/rebuild_queue.hpp"
#include "src/rviz/materials.hpp"
#include "src/rviz/view_scale.hpp"

namespace desert_sim {

PlantObjects::PlantObjects(Ogre::SceneNode* parent, double east, double north,
                           std::shared_ptr<const render::PlantTiles> plants)
    : node_(parent->createChildSceneNode(
          Ogre::Vector3(static_cast<Ogre::Real>(east), static_cast<Ogre::Real>(north), 0))),
      plants_(std::move(plants)) {}

PlantObjects::~PlantObjects() {
  tiles_.clear();
  node_->getCreator()->destroySceneNode(node_);
}

void PlantObjects::update(const Ogre::Camera& camera, int viewport_height, double exaggeration,
                          const render::PlantLimits& limits, double seconds, bool hidden) {
  const double begin = render::RebuildQueue::steady_seconds();
  const auto in_detail = [this](std::size_t tile) {
    const auto found = tiles_.find(tile);
    return found != tiles_.end() && found->second.detailed;
  };
  const render::View view = view_of(camera, viewport_height, *node_);
  ++frame_;
  drawn_ = waiting_ = 0;
  bool built = false;
  for (const render::ChosenTile& chosen :
       render::choose_plant_tiles(*plants_, view, exaggeration, limits, in_detail)) {
    auto found = tiles_.find(chosen.tile);
    const bool fits = found != tiles_.end() && found->second.detailed == chosen.detailed &&
                      found->second.exaggeration == exaggeration;
    if (!fits && (!built || render::RebuildQueue::steady_seconds() - begin < seconds)) {
      if (found == tiles_.end()) found = tiles_.emplace(chosen.tile, Tile()).first;
      build(chosen, exaggeration, found->second);
      built = true;
    } else if (!fits) {
      ++waiting_;
    }
    if (found == tiles_.end()) continue;
    Tile& tile = found->second;
    tile.object->draw_first(hidden ? 0 : chosen.plants * render::indices_of_plant(tile.detailed));
    tile.frame = frame_;
    drawn_ += chosen.plants;
  }
  hide_others(limits.plants);
}

void PlantObjects::build(const render::ChosenTile& chosen, double exaggeration, Tile& tile) {
  if (!tile.object)
    tile.object =
        std::make_unique<MeshObject>(node_, materials::shapes(), Ogre::RenderOperation::OT_TRIANGLE_LIST);
  tile.object->set_mesh(plants_->mesh(plants_->tiles()[chosen.tile], chosen.detailed, exaggeration));
  tile.detailed = chosen.detailed;
  tile.exaggeration = exaggeration;
}

/// Hides the tiles that were not drawn in this frame; forgets some of them, those longest out of sight, while
/// all together have more than twice as many plants as may be drawn.
void PlantObjects::hide_others(std::size_t most_plants) {
  constexpr std::size_t at_once = 16;
  std::vector<std::pair<std::uint64_t, std::size_t>> hidden;  // frame, tile
  std::size_t kept = 0;
  for (auto& [number, tile] : tiles_) {
    kept += plants_->tiles()[number].count;
    if (tile.frame == frame_) continue;
    tile.object->draw_first(0);
    hidden.emplace_back(tile.frame, number);
  }
  if (kept <= 2 * most_plants) return;
  const auto end = hidden.begin() + static_cast<std::ptrdiff_t>(std::min(at_once, hidden.size()));
  std::partial_sort(hidden.begin(), end, hidden.end());
  for (auto oldest = hidden.begin(); oldest != end && kept > 2 * most_plants; ++oldest) {
    kept -= plants_->tiles()[oldest->second].count;
    tiles_.erase(oldest->second);
  }
}

}  // namespace desert_sim
