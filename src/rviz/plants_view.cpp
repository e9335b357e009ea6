#include "src/rviz/plants_view.hpp"

#include <chrono>
#include <cstdlib>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <utility>

#include "src/render/drawable.hpp"
#include "src/rviz/message_meshes.hpp"

namespace desert_sim {

namespace {

template <class T>
bool is_ready(const std::future<T>& future) {
  return future.valid() && future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

PlantsView::PlantsView(Ogre::SceneNode* parent, const Ogre::MaterialPtr& ground)
    : parent_(parent), cover_(ground) {}

void PlantsView::subscribe(ros::NodeHandle& node, const std::string& topic) {
  inbox_.subscribe(node, topic);
  ++subscription_;
  clear();
}

void PlantsView::clear() {
  for (std::unique_ptr<PlantObjects>* const objects : {&shown_, &next_}) {
    if (*objects) old_.push_back((*objects)->plants());
    objects->reset();
  }
  cover_.clear();
  free_old();
}

void PlantsView::update(const Ogre::Camera& camera, int viewport_height, const Settings& settings) {
  if (take_prepared()) return;  // to make a texture takes its time
  prepare(settings);
  cover_.update(settings.seconds / 2);
  render::PlantLimits limits;
  limits.plants = settings.most;
  const double seconds = settings.seconds / 2;
  if (next_ && shown_) {
    next_->update(camera, viewport_height, settings.exaggeration, limits, seconds, true);
    if (next_->waiting() == 0) replace();
  } else if (next_) {
    replace();
  }
  if (shown_) shown_->update(camera, viewport_height, settings.exaggeration, limits, next_ ? 0 : seconds);
  free_old();
}

void PlantsView::replace() {
  if (shown_) old_.push_back(shown_->plants());
  shown_ = std::move(next_);
}

/// Gives the newest message to a thread of its own, if the one before is shown as a whole.
void PlantsView::prepare(const Settings& s) {
  if (preparing_.valid() || next_ || cover_.waiting() > 0) return;
  Plants::ConstPtr newest = inbox_.take();
  if (!newest) return;
  Prepared empty;
  empty.subscription = subscription_;
  empty.east = newest->origin.position.x - s.corner_x;
  empty.north = newest->origin.position.y - s.corner_y;
  const bool drawable = render::is_drawable(empty.east) && render::is_drawable(empty.north);
  if (!drawable) empty.east = empty.north = 0;
  // The walls at the edges of a terrain have the colour of what is painted there.
  const render::CoverBounds bounds{s.cell_size - empty.east, s.cell_size - empty.north,
                                   s.width - s.cell_size - empty.east, s.height - s.cell_size - empty.north};
  preparing_ =
      std::async(std::launch::async, [empty, bounds, drawable, message = std::move(newest)]() mutable {
        Prepared prepared = empty;
        auto plants =
            std::make_shared<render::PlantTiles>(drawable ? plant_tiles(*message) : render::PlantTiles());
        message.reset();
        prepared.cover = std::make_shared<render::CoverPicture>(render::plant_cover(*plants, bounds));
        prepared.plants = std::move(plants);
        return prepared;
      });
}

bool PlantsView::take_prepared() {
  if (!is_ready(preparing_)) return false;
  Prepared prepared = preparing_.get();
  if (prepared.subscription != subscription_) {
    old_.insert(old_.end(), {prepared.cover, prepared.plants});
    return false;
  }
  next_ = std::make_unique<PlantObjects>(parent_, prepared.east, prepared.north, prepared.plants);
  cover_.set(prepared.cover, prepared.east, prepared.north);
  picture_ = std::move(prepared.cover);
  return true;
}

/// Frees what is no longer drawn in a thread of its own: tens of megabytes take milliseconds.
void PlantsView::free_old() {
  if (picture_ && cover_.waiting() == 0) old_.push_back(std::move(picture_));
  if (old_.empty() || (freeing_.valid() && !is_ready(freeing_))) return;
  freeing_ = std::async(std::launch::async, [old = std::move(old_)]() mutable {
    old.clear();
#ifdef __GLIBC__
    malloc_trim(0);  // it would keep most of the memory
#endif
  });
  old_.clear();
}

std::size_t PlantsView::shown() const { return shown_ ? shown_->drawn() : 0; }
std::size_t PlantsView::total() const { return shown_ ? shown_->plants()->plants().size() : 0; }
std::size_t PlantsView::waiting() const {
  const PlantObjects* const objects = next_ ? next_.get() : shown_.get();
  return (objects ? objects->waiting() : 0) + cover_.waiting() + (preparing_.valid() ? 1 : 0) +
         (next_ ? 1 : 0);
}

}  // namespace desert_sim
