#include "src/rviz/terrain_scene.hpp"

#include <OgreSceneNode.h>

#include <cmath>

#include "src/rviz/materials.hpp"

namespace desert_sim {

namespace {

Eigen::Matrix4d to_matrix(const Ogre::Matrix4& m) {
  using RowByRow = Eigen::Matrix<Ogre::Real, 4, 4, Eigen::RowMajor>;
  return Eigen::Map<const RowByRow>(m[0]).cast<double>();
}

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
    : parent_(parent), node_(parent->createChildSceneNode()) {}

TerrainScene::~TerrainScene() {
  blocks_.clear();
  node_->getCreator()->destroySceneNode(node_);
}

void TerrainScene::set_grid(int width, int height, double cell_size, const render::LayerWindow& window) {
  layout_ = render::BlockLayout(width, height);
  cell_size_ = cell_size;
  window_ = window;
  base_ = render::base_of_walls(layout_, cell_size_, window_);
  queue_.reset(layout_);
  blocks_.clear();
  blocks_.resize(static_cast<std::size_t>(layout_.count()));
  boxes_.clear();
  for (int block = 0; block < layout_.count(); ++block)
    boxes_.push_back(rough_box(layout_.vertices(block), cell_size_, window_));
}

void TerrainScene::set_look(const render::TerrainLook& look) {
  look_ = look;
  node_->setScale(1, 1, static_cast<Ogre::Real>(look.vertical_exaggeration));
  queue_.touch_all();
}

render::View TerrainScene::view_of(const Ogre::Camera& camera, int viewport_height) const {
  const Ogre::Matrix4 terrain(parent_->_getFullTransform());
  return {to_matrix(camera.getProjectionMatrix()),
          to_matrix(Ogre::Matrix4(camera.getViewMatrix(true)) * terrain), viewport_height};
}

void TerrainScene::update(const Ogre::Camera& camera, int viewport_height, double seconds) {
  if (layout_.count() == 0) return;
  const render::View view = view_of(camera, viewport_height);
  std::vector<render::Box> boxes = boxes_;
  for (render::Box& box : boxes) {
    box.min().z() *= look_.vertical_exaggeration;
    box.max().z() *= look_.vertical_exaggeration;
  }
  queue_.set_levels(render::choose_levels(layout_, cell_size_, view, boxes, queue_.levels(), limits_));
  queue_.run(view, boxes, seconds, [this](int block, int level) { build(block, level); });
}

void TerrainScene::build(int number, int level) {
  using Ogre::RenderOperation;
  const render::TerrainBlock meshes =
      render::build_terrain_block(layout_, number, level, cell_size_, window_, look_, base_);
  Block& block = blocks_[static_cast<std::size_t>(number)];
  const auto show = [this](std::unique_ptr<MeshObject>& object, const render::Mesh& mesh,
                           const Ogre::MaterialPtr& material, RenderOperation::OperationType type) {
    if (mesh.empty()) {
      object.reset();
      return;
    }
    if (!object) object = std::make_unique<MeshObject>(node_, material, type);
    object->set_mesh(mesh);
  };
  show(block.ground, meshes.ground, materials::ground(), RenderOperation::OT_TRIANGLE_LIST);
  show(block.water, meshes.water, materials::translucent(), RenderOperation::OT_TRIANGLE_LIST);
  show(block.contours, meshes.contours, materials::translucent(), RenderOperation::OT_LINE_LIST);
  block.triangles = static_cast<std::int64_t>(meshes.ground.indices.size() / 3);
  if (!meshes.ground.empty()) boxes_[static_cast<std::size_t>(number)] = render::bounding_box(meshes.ground);
  ++built_;
}

TerrainScene::Counts TerrainScene::counts() const {
  Counts counts{layout_.count(), queue_.waiting(), built_, 0};
  for (const Block& block : blocks_) counts.triangles += block.triangles;
  return counts;
}

}  // namespace desert_sim
