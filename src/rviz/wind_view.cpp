#include "src/rviz/wind_view.hpp"

#include <cmath>
#include <limits>

#include "src/render/drawable.hpp"
#include "src/render/wind_arrows.hpp"
#include "src/rviz/materials.hpp"

namespace desert_sim {

void WindView::subscribe(ros::NodeHandle& node, const std::string& topic) {
  inbox_.subscribe(node, topic);
  message_.reset();
  object_.reset();
}

void WindView::update(const LayerMap& ground, int most) {
  const WindField::ConstPtr newest = inbox_.take();
  if (newest) message_ = newest;
  if (!message_ || (!newest && most == most_)) return;
  most_ = most;
  const WindField& m = *message_;
  const std::size_t cells = static_cast<std::size_t>(m.width) * m.height;
  if (m.u.size() != cells || m.v.size() != cells) return;
  const LayerMap::Info& info = ground.info();
  if (!render::is_drawable(m.cell_size) || !render::is_drawable(m.origin.position.x - info.origin_x) ||
      !render::is_drawable(m.origin.position.y - info.origin_y))
    return;
  const render::WindGrid wind{static_cast<int>(m.width),
                              static_cast<int>(m.height),
                              m.cell_size,
                              m.origin.position.x - info.origin_x,
                              m.origin.position.y - info.origin_y,
                              m.u,
                              m.v,
                              std::hypot(m.above.x, m.above.y)};
  const auto height = [&](double x, double y) {
    return ground.value(info.origin_x + x, info.origin_y + y)
        .value_or(std::numeric_limits<double>::quiet_NaN());
  };
  if (!object_)
    object_ =
        std::make_unique<MeshObject>(parent_, materials::shapes(), Ogre::RenderOperation::OT_TRIANGLE_LIST);
  object_->set_mesh(render::wind_arrows(wind, most, height));
}

}  // namespace desert_sim
