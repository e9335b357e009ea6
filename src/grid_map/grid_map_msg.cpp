#include "src/grid_map/grid_map_msg.hpp"

namespace desert_sim {

namespace {

constexpr const char* map_fields = R"(GridMapInfo info
string[] layers
string[] basic_layers
std_msgs/Float32MultiArray[] data
uint16 outer_start_index
uint16 inner_start_index
)";

constexpr const char* info_fields = R"(Header header
float64 resolution
float64 length_x
float64 length_y
geometry_msgs/Pose pose
)";

std::string section(const char* type, const std::string& fields) {
  return "\n" + std::string(80, '=') + "\nMSG: " + type + "\n" + fields;
}

/// The definitions of the message types that GridMap contains.
std::string nested_definitions() {
  namespace traits = ros::message_traits;
  return section("grid_map_msgs/GridMapInfo", info_fields) +
         section("std_msgs/Header", traits::definition<std_msgs::Header>()) +
         section("geometry_msgs/Pose", traits::definition<geometry_msgs::Pose>()) +
         section("std_msgs/Float32MultiArray", traits::definition<std_msgs::Float32MultiArray>());
}

}  // namespace

std::string GridMapType<GridMap>::definition() { return map_fields + nested_definitions(); }

std::string GridMapType<GetGridMapRequest>::definition() {
  return "string frame_id\nfloat64 position_x\nfloat64 position_y\nfloat64 length_x\nfloat64 length_y\n"
         "string[] layers\n";
}

std::string GridMapType<GetGridMapResponse>::definition() {
  return "grid_map_msgs/GridMap map\n" + section("grid_map_msgs/GridMap", map_fields) + nested_definitions();
}

}  // namespace desert_sim
