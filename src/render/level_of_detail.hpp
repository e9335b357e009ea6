#pragma once
/// Chooses at which level each block is drawn: as coarse as its distance allows, and with no more triangles
/// in the picture than wanted.

#include <vector>

#include "src/render/block_layout.hpp"
#include "src/render/view.hpp"

namespace desert_sim::render {

struct DetailLimits {
  double pixels = 4;  ///< A quad of a mesh may be so large [pixels] if there is a finer level.
  int triangles =
      100000;  ///< At most so many in the picture; where needed, quads become larger than `pixels`.
};

/// One level for each block. `boxes` are the blocks' bounding boxes, `present` the levels they are drawn at
/// now (-1: not yet): a block keeps its level until another one fits clearly better, so that levels do not
/// change back and forth.
std::vector<int> choose_levels(const BlockLayout& layout, double cell_size, const View& view,
                               const std::vector<Box>& boxes, const std::vector<int>& present,
                               const DetailLimits& limits);

/// The number of triangles of a block's surface at a level, if no cell is unknown.
int surface_triangles(const BlockLayout& layout, int block, int level);

}  // namespace desert_sim::render
