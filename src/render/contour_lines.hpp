#pragma once
/// Lines of equal height on a mesh.

#include "src/render/mesh.hpp"

namespace desert_sim::render {

/// Lines at multiples of `interval` [m] on the surface of a mesh (not on its skirts), with the normals of the
/// surface; every fifth is darker. Empty if the interval is not above 0. No triangle has more than `most`
/// lines: a steep one has only those at multiples of five intervals, or none.
Mesh contour_lines(const Mesh& mesh, double interval, int most = 8);

}  // namespace desert_sim::render
