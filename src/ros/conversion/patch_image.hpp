#pragma once
/// A brush's patch from an image message.

#include <sensor_msgs/Image.h>

#include "src/simulation/commands/command.hpp"

namespace desert_sim {

/// Pixels times `scale`: mono8 and mono16 count 0 … 1 from black to white, 32FC1 as it is. Rows may be
/// padded, and of either byte order. Throws ConfigError if the encoding is another one or size, step and data
/// do not fit together.
command::Patch patch_of(const sensor_msgs::Image& image, double scale);

}  // namespace desert_sim
