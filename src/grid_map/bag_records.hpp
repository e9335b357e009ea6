#pragma once
/// Checks the records of bag files; the format is described at https://wiki.ros.org/Bags/Format/2.0.

#include "src/core/input_file.hpp"

namespace desert_sim {

/// Checks that the records of a bag (version 2.0) follow one another up to the end of the file, also inside
/// uncompressed chunks, and that index entries point to records. Throws ConfigError with the byte offset
/// otherwise. The rosbag library trusts the lengths in a file, so that a corrupt length makes it read out of
/// bounds. Compressed chunks have checksums of their own.
void validate_bag_records(const InputFile& file);

}  // namespace desert_sim
