#pragma once
/// Lines on the map that are laid on the terrain, and what can be measured along them.

#include <vector>

#include "src/render/height_field.hpp"
#include "src/render/mesh.hpp"

namespace desert_sim::render {

/// A circle of 96 sides; the first place is the last, too.
std::vector<Place> circle(const Place& centre, double radius);

/// The line with further places on it, so that none is further than a cell from the next one, and at most
/// 4096 in all, each at the height of the surface; z is NaN where that is unknown, and outside the grid.
std::vector<Point> drape(const HeightField& field, const std::vector<Place>& line);

/// What is between the ends of a line on the terrain.
struct Measurement {
  double horizontal = 0;         ///< distance on the map [m]
  double along_surface = 0;      ///< length of the line [m]; NaN if it has unknown heights
  double height_difference = 0;  ///< of its end above its begin [m]; NaN if one of them is unknown
  double slope = 0;              ///< of the straight line between both ends, -π/2 … π/2 [rad]
};
Measurement measure(const std::vector<Point>& line);

/// The line as one mesh of lines; heights are multiplied by `exaggeration`. Places of unknown height are
/// gaps.
void append_line(Mesh& mesh, const std::vector<Point>& line, double exaggeration, PackedColour colour);

}  // namespace desert_sim::render
