#pragma once
/// Frames of one value around the data of a raster, which a projection leaves where no nodata is declared.

#include <optional>
#include <string>

#include "src/io/raster.hpp"

namespace desert_sim {

struct Frame {
  float value;       ///< of all its cells
  std::size_t cell;  ///< index of one of them
  long long cells;   ///< that reach the raster's edge through cells of that value
  float step;        ///< median height of the step between it and the data
};

/// The frame that seems to stand for missing data: a quarter of the outermost cells or more, on all four
/// sides, have one value exactly, and where they and their like end, the ground steps by a metre or more, and
/// by 20 times as much as between neighbours elsewhere that differ (medians); a quarter of all cells at least
/// are not in it. Of a raster that is a `part` of another, which has a part of the frame, a tenth of the
/// outermost cells on any side. Nothing for a sea around an island, whose shore is no steeper than its hills.
std::optional<Frame> find_frame(const Raster& raster, bool part = false);

/// Logs a warning of the frame, whose cells have the number `raw` in the file.
void warn_of_frame(const std::string& path, const Frame& frame, double raw);

}  // namespace desert_sim
