#pragma once
/// Encodes a bag with one message in memory. rosbag::Bag writes to files only, and ends the program if the
/// disk is full, because its destructor writes the index and throws.

#include <ros/datatypes.h>
#include <ros/time.h>

#include <string>

namespace desert_sim {

/// A bag of format 2.0 (http://wiki.ros.org/Bags/Format/2.0) with one connection and one uncompressed chunk.
/// `connection_header` has at least type, md5sum and message_definition, and `message` is serialised. Both
/// together have at most 4 GB.
std::string bag_bytes(const std::string& topic, const ros::M_string& connection_header, const ros::Time& time,
                      const std::string& message);

}  // namespace desert_sim
