#include "src/rviz/plants_view.hpp"

#include "src/render/drawable.hpp"
#include "src/render/plant_shapes.hpp"
#include "src/rviz/materials.hpp"

namespace desert_sim {

using render::is_drawable;

void PlantsView::subscribe(ros::NodeHandle& node, const std::string& topic) {
  inbox_.subscribe(node, topic);
  message_.reset();
  object_.reset();
  shown_ = 0;
}

void PlantsView::update(double corner_x, double corner_y, double vertical_exaggeration, int most) {
  const Plants::ConstPtr newest = inbox_.take();
  if (newest) message_ = newest;
  if (!message_ || (!newest && vertical_exaggeration == exaggeration_ && most == most_)) return;
  exaggeration_ = vertical_exaggeration;
  most_ = most;
  const Plants& m = *message_;
  const std::size_t count = std::min(
      {m.x.size(), m.y.size(), m.z.size(), m.radius.size(), m.species_index.size(), m.health.size()});
  // Plants that no desert has are not drawn: Ogre ends a program whose meshes are not finite.
  std::vector<std::size_t> drawn;
  std::vector<float> radii;
  for (std::size_t n = 0; n < count; ++n) {
    if (m.species_index[n] >= m.species.size() || !is_drawable(m.x[n]) || !is_drawable(m.y[n]) ||
        !is_drawable(m.z[n]) || !is_drawable(m.radius[n]) ||
        !is_drawable(m.species[m.species_index[n]].stem) || !is_drawable(m.origin.position.x - corner_x) ||
        !is_drawable(m.origin.position.y - corner_y))
      continue;
    drawn.push_back(n);
    radii.push_back(m.radius[n]);
  }
  std::vector<render::Plant> plants;
  std::vector<std::uint8_t> species;
  for (const std::size_t chosen : render::widest_plants(radii, static_cast<std::size_t>(most))) {
    const std::size_t n = drawn[chosen];
    const std::uint8_t kind = m.species_index[n];
    plants.push_back({m.origin.position.x - corner_x + static_cast<double>(m.x[n]),
                      m.origin.position.y - corner_y + static_cast<double>(m.y[n]),
                      static_cast<double>(m.z[n]), static_cast<double>(m.radius[n]),
                      static_cast<double>(m.species[kind].stem), m.health[n] / 255.0});
    species.push_back(kind);
  }
  render::PlantLook look;
  look.vertical_exaggeration = vertical_exaggeration;
  for (const PlantSpecies& one : m.species) look.colours.push_back(render::crown_colour(one.hue));
  if (!object_)
    object_ =
        std::make_unique<MeshObject>(parent_, materials::shapes(), Ogre::RenderOperation::OT_TRIANGLE_LIST);
  object_->set_mesh(render::plants_mesh(plants, species, look));
  shown_ = plants.size();
}

}  // namespace desert_sim
