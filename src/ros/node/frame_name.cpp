#include "src/ros/node/frame_name.hpp"

#include <ros/names.h>

#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

void check_frame(std::string& frame, const std::string& key, Faults& faults) {
  if (!frame.empty() && frame[0] == '/') frame.erase(0, 1);
  std::string reason;
  if (frame.empty() || !ros::names::validate(frame, reason))
    faults.add(key, "'" + frame + "' is not the name of a frame" + (reason.empty() ? "" : ": " + reason));
}

}  // namespace desert_sim
