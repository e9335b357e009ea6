#include "src/rviz/terrain_scene.hpp"

#include <OgreSceneNode.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/render/contour_lines.hpp"
#include "src/rviz/materials.hpp"
#include "src/rviz/view_scale.hpp"

namespace desert_sim {

namespace {

/// The place of a block before it has a mesh: its heights are those of some of its cells.
render::Box rough_box(const render::CellRectangle& cells, double cell_size,
                      const render::LayerWindow& window) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (int y : {cells.y, cells.y + cells.height / 2, cells.top() - 1})
    for (int x : {cells.x, cells.x + cells.width / 2, cells.right() - 1}) {
      const double z = static_cast<double>(window("elevation", {x, y, 1, 1}).at(x, y));
      low = std::fmin(low, z);
      high = std::fmax(high, z);
    }
  if (low > high) low = high = 0;
  return {render::Point(cells.x * cell_size, cells.y * cell_size, low),
          render::Point(cells.right() * cell_size, cells.top() * cell_size, high)};
}

}  // namespace

TerrainScene::TerrainScene(Ogre::SceneNode* parent)
    : parent_(parent), node_(parent->createChildSceneNode()), ground_material_(materials::new_ground()) {}

TerrainScene::~TerrainScene() {
  near_ground_.reset();
  near_contours_.reset();
  blocks_.clear();
  node_->getCreator()->destroySceneNode(node_);
  materials::remove(ground_material_);
}

void TerrainScene::set_grid(int width, int height, double cell_size, const render::LayerWindow& window) {
  grid_ = {render::BlockLayout(width, height), cell_size};
  window_ = batch_window_ = window;
  grid_.base = render::base_of_walls(grid_.layout, cell_size, window_);
  queue_.reset(grid_.layout);
  staged_.clear();
  next_near_.reset();
  batch_near_.reset();
  show_near({});
  blocks_.clear();
  blocks_.resize(static_cast<std::size_t>(grid_.layout.count()));
  boxes_.clear();
  for (int block = 0; block < grid_.layout.count(); ++block)
    boxes_.push_back(rough_box(grid_.layout.vertices(block), cell_size, window_));
}

void TerrainScene::set_look(const render::TerrainLook& look) {
  look_ = look;
  node_->setScale(1, 1, static_cast<Ogre::Real>(look.vertical_exaggeration));
  grid_.shadow_reach = 0;  // chosen anew with the next batch
  queue_.touch_all();
}

void TerrainScene::set_near_ground(const render::CellRectangle& cells, render::Mesh ground) {
  const bool stays = cells == grid_.hole && !next_near_ && !batch_near_;
  if (stays && cells.empty()) return;
  if (stays) return show_near({cells, std::move(ground)});
  for (const render::CellRectangle& changed : {grid_.hole, cells})
    if (!changed.empty()) queue_.touch(changed);
  if (next_near_ && !next_near_->cells.empty()) queue_.touch(next_near_->cells);
  next_near_ = NearMesh{cells, std::move(ground)};
}

void TerrainScene::show_near(const NearMesh& near) {
  put(near_ground_, near.ground, ground_material_, Ogre::RenderOperation::OT_TRIANGLE_LIST);
  put(near_contours_, render::contour_lines(near.ground, look_.contour_interval), materials::translucent(),
      Ogre::RenderOperation::OT_LINE_LIST);
  near_triangles_ = static_cast<std::int64_t>(near.ground.indices.size() / 3);
}

/// The hole in the blocks is cut between cells: where it is, or is to be, they are drawn cell by cell.
void TerrainScene::keep_fine(std::vector<int>& levels) const {
  const render::CellRectangle& next = next_near_ ? next_near_->cells : grid_.hole;
  for (const render::CellRectangle& hole : {grid_.hole, next})
    for (const int block : hole.empty() ? std::vector<int>() : grid_.layout.touched(hole, queue_.levels()))
      levels[static_cast<std::size_t>(block)] = 0;
}

render::View TerrainScene::view_of(const Ogre::Camera& camera, int viewport_height) const {
  return desert_sim::view_of(camera, viewport_height, *parent_);
}

double TerrainScene::most_pixels_per_metre(const render::View& view) const {
  double most = 0;
  for (const render::Box& box : boxes_as_seen()) most = std::max(most, view.pixels_per_metre(box));
  return most;
}

std::vector<render::Box> TerrainScene::boxes_as_seen() const {
  std::vector<render::Box> boxes = boxes_;
  for (render::Box& box : boxes) {
    box.min().z() *= look_.vertical_exaggeration;
    box.max().z() *= look_.vertical_exaggeration;
  }
  return boxes;
}

void TerrainScene::begin_batch(const render::View& view) {
  const std::vector<render::Box> boxes = boxes_as_seen();
  render::Box all;
  for (const render::Box& box : boxes) all.extend(box);
  const int reach = look_.shadows ? render::shadow_reach(all.sizes().z(), grid_.cell_size) : 0;
  if (reach > grid_.shadow_reach) {
    grid_.shadow_reach =
        std::min(reach + reach / 4, render::longest_shadow);  // hills grow a little at a time
    queue_.touch_all();
  }
  batch_window_ = window_;
  if (next_near_) {
    grid_.hole = next_near_->cells;
    batch_near_ = std::move(next_near_);
    next_near_.reset();
  }
  queue_.begin_batch(view, boxes);
}

void TerrainScene::update(const Ogre::Camera& camera, int viewport_height, double seconds, bool hold) {
  if (grid_.layout.count() == 0) return;
  const render::View view = view_of(camera, viewport_height);
  std::vector<int> levels =
      render::choose_levels(grid_.layout, grid_.cell_size, view, boxes_as_seen(), queue_.levels(), limits_);
  keep_fine(levels);
  queue_.set_levels(levels);
  if (queue_.waiting() == 0) return;
  if (queue_.batch_complete() && !hold) begin_batch(view);
  queue_.run(seconds, [this](int block, int level) { build(block, level); });
  if (!queue_.batch_complete()) return;
  for (const Staged& one : staged_) show(one.block, one.meshes);
  staged_.clear();
  if (batch_near_) show_near(*batch_near_);
  batch_near_.reset();
}

void TerrainScene::build(int number, int level) {
  render::TerrainBlock meshes = render::build_terrain_block(grid_, number, level, batch_window_, look_);
  ++built_;
  const bool replaces = blocks_[static_cast<std::size_t>(number)].ground != nullptr;
  if (replaces && !queue_.batch_complete())
    staged_.push_back({number, std::move(meshes)});
  else
    show(number, meshes);
}

void TerrainScene::put(std::unique_ptr<MeshObject>& object, const render::Mesh& mesh,
                       const Ogre::MaterialPtr& material, Ogre::RenderOperation::OperationType type) {
  if (mesh.empty()) {
    object.reset();
    return;
  }
  if (!object) object = std::make_unique<MeshObject>(node_, material, type);
  object->set_mesh(mesh);
}

void TerrainScene::show(int number, const render::TerrainBlock& meshes) {
  using Ogre::RenderOperation;
  Block& block = blocks_[static_cast<std::size_t>(number)];
  put(block.ground, meshes.ground, ground_material_, RenderOperation::OT_TRIANGLE_LIST);
  put(block.water, meshes.water, materials::translucent(), RenderOperation::OT_TRIANGLE_LIST);
  put(block.contours, meshes.contours, materials::translucent(), RenderOperation::OT_LINE_LIST);
  block.triangles = static_cast<std::int64_t>(meshes.ground.indices.size() / 3);
  if (!meshes.ground.empty()) boxes_[static_cast<std::size_t>(number)] = render::bounding_box(meshes.ground);
}

TerrainScene::Counts TerrainScene::counts() const {
  Counts counts{grid_.layout.count(), queue_.waiting(), built_, 0, near_triangles_};
  for (const Block& block : blocks_) counts.triangles += block.triangles;
  return counts;
}

}  // namespace desert_sim
