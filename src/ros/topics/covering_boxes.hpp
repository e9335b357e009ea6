#pragma once
/// Few rectangles that have many boxes of cells between them, for messages that carry rectangles.

#include <vector>

#include "kernels/field/cell_box.hpp"

namespace desert_sim {

/// At most `most` rectangles (at least 1) that have all of `boxes`; each box is in one of them as a whole. It
/// begins with the bounding box, and cuts the rectangle in two whose halves, tight around their boxes, save
/// most cells, until no cut saves `worth` cells. The rectangles may overlap. O(most n log n).
std::vector<CellBox> covering_boxes(const std::vector<CellBox>& boxes, int most, long worth = 0);

}  // namespace desert_sim
