#pragma once
/// Bags as files: https://wiki.ros.org/Bags/Format/2.0.

#include <string>

namespace desert_sim {

/// Throws ConfigError, with the byte, unless the records of a bag (version 2.0) lie one behind the other up
/// to its end, those in its uncompressed chunks too, and indexes point to records. rosbag's own library
/// trusts their lengths: a damaged one makes it read beyond its memory. Compressed chunks have checksums of
/// their own.
void require_whole_records(const std::string& path);

}  // namespace desert_sim
