#pragma once
/// Plants as a few triangles each: for markers and for the plugin of rviz.

#include <vector>

#include "src/render/mesh.hpp"

namespace desert_sim::render {

/// A plant in the terrain's frame [m].
struct Plant {
  double x = 0, y = 0, foot = 0;  ///< where stem and root meet
  double radius = 0;
  double stem = 1;    ///< ratio of the stem's height to the radius
  double health = 1;  ///< 0…1; in bad health it is drawn lower

  double height() const { return radius * stem * (0.5 + 0.5 * health); }
};

/// Adds the corners of the triangles of a plant, three for each, counter-clockwise as seen from outside.
/// Detailed: a trunk, and a crown of two cones with six sides. Else: a pyramid.
void add_plant(const Plant& plant, bool detailed, std::vector<Point>& corners);

/// The same with flat light on a crown of this colour, as indices_of_plant() indices of a mesh.
void add_plant(const Plant& plant, bool detailed, const Colour& colour, Mesh& mesh);
constexpr std::size_t indices_of_plant(bool detailed) { return 3 * (detailed ? 15 : 4); }

/// The indices of the `count` widest plants, in ascending order; among plants of equal width the first ones
/// count.
std::vector<std::size_t> widest_plants(const std::vector<float>& radii, std::size_t count);

struct PlantLook {
  std::vector<Colour> colours;       ///< by species
  double vertical_exaggeration = 1;  ///< of the feet; plants keep their shape
  bool light = true;                 ///< else their colours are those of the species
};

/// One mesh of all these plants, with flat light; the widest tenth is detailed. `species` has one number for
/// each.
Mesh plants_mesh(const std::vector<Plant>& plants, const std::vector<std::uint8_t>& species,
                 const PlantLook& look);

}  // namespace desert_sim::render
