#pragma once
/// Checks the records of bag files; the format is described at https://wiki.ros.org/Bags/Format/2.0.

#include "src/core/input_file.hpp"

namespace desert_sim {

/// Checks that the records of a bag (version 2.0) follow one another up to the end of the file, also
/// inside chunks, that descriptions of chunks point to chunks, and index entries to messages. Throws
/// ConfigError with the byte offset otherwise, and for a bag that is encrypted or has a chunk that
/// unpacks to more than 64 MiB and a hundred times its size. The rosbag library trusts the numbers in a
/// file, so that a corrupt one makes it read out of bounds or allocate gigabytes.
void validate_bag_records(const InputFile& file);

}  // namespace desert_sim
