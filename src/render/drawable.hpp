#pragma once
/// What can be drawn: coordinates and sizes of deserts. Messages can say anything, and Ogre ends a program
/// whose meshes are not finite.

#include <cmath>

namespace desert_sim::render {

/// Whether a number is finite, and within the range of what deserts have.
inline bool is_drawable(double value) { return std::abs(value) <= 1e7; }

}  // namespace desert_sim::render
