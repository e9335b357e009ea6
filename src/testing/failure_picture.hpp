#pragma once
/// A picture of what a test has found.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "include/desert_sim/client/layer_map.hpp"
#include "include/desert_sim/testing/paths.hpp"

namespace desert_sim::test {

struct FailurePicture {
  std::shared_ptr<const LayerMap> elevation;
  std::vector<std::int8_t> costs;         ///< of each cell, as in ~costmap: lethal ones are tinted red
  std::vector<Point> way;                 ///< of the rover, in white
  std::vector<std::vector<Point>> paths;  ///< in blue
  std::optional<Pose> rover;              ///< a red arrow
  std::optional<Point> goal;              ///< a green cross
};

/// Whether this build can write pictures: DESERT_PARTS=client has no OpenCV.
constexpr bool has_failure_pictures = DESERT_WITH_IO;

/// Writes it as a PNG file, north up. Throws ConfigError or WriteError that names the file, and Error in a
/// build without pictures.
void write_failure_picture(const std::string& path, const FailurePicture& picture);

}  // namespace desert_sim::test
