#pragma once
/// grid_map_msgs/GridMap and GetGridMap, wire-compatible with the original types, without a dependency on
/// grid_map. The traits and serializers below give roscpp the types' names, checksums, definitions and order
/// of fields.
///
/// Layout, as in grid_map: the pose is the map's centre; logical index (0, 0) is the cell in the corner of
/// largest x and y; rows run towards lower x, columns towards lower y; the array is data[column * rows +
/// row]; dim[0] is {"column_index", columns, rows * columns} and dim[1] is {"row_index", rows, rows}. NaN
/// means no data.

#include <geometry_msgs/Pose.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/service_traits.h>
#include <std_msgs/Float32MultiArray.h>
#include <std_msgs/Header.h>

#include <string>
#include <vector>

namespace desert_sim {

struct GridMapInfo {
  std_msgs::Header header;
  double resolution = 0;              ///< [m/cell]
  double length_x = 0, length_y = 0;  ///< [m]
  geometry_msgs::Pose pose;           ///< pose of the centre
};

struct GridMap {
  GridMapInfo info;
  std::vector<std::string> layers;
  std::vector<std::string> basic_layers;  ///< a cell is valid if these layers are
  std::vector<std_msgs::Float32MultiArray> data;
  std::uint16_t outer_start_index = 0, inner_start_index = 0;
};

struct GetGridMapRequest {
  std::string frame_id;
  double position_x = 0, position_y = 0;  ///< centre of the region [m]
  double length_x = 0, length_y = 0;      ///< [m]
  std::vector<std::string> layers;        ///< all if empty
};
struct GetGridMapResponse {
  GridMap map;
};
struct GetGridMap {
  using Request = GetGridMapRequest;
  using Response = GetGridMapResponse;
};

/// Name, checksum and definition of a type of grid_map_msgs.
template <class M>
struct GridMapType;

template <>
struct GridMapType<GridMap> {
  static constexpr const char* name = "grid_map_msgs/GridMap";
  static constexpr const char* md5 = "95681e052b1f73bf87b7eb984382b401";
  static std::string definition();
};
template <>
struct GridMapType<GetGridMapRequest> {
  static constexpr const char* name = "grid_map_msgs/GetGridMapRequest";
  // A request and a response have the checksum of their service.
  static constexpr const char* md5 = "802c2cbc7b10fada2d44db75ddb8c738";
  static std::string definition();
};
template <>
struct GridMapType<GetGridMapResponse> {
  static constexpr const char* name = "grid_map_msgs/GetGridMapResponse";
  static constexpr const char* md5 = "802c2cbc7b10fada2d44db75ddb8c738";
  static std::string definition();
};
template <>
struct GridMapType<GetGridMap> {
  static constexpr const char* name = "grid_map_msgs/GetGridMap";
  static constexpr const char* md5 = "802c2cbc7b10fada2d44db75ddb8c738";
};

}  // namespace desert_sim

namespace ros {
namespace message_traits {

#define DESERT_GRID_MAP_MESSAGE(M)                                              \
  template <>                                                                   \
  struct IsMessage<M> : TrueType {};                                            \
  template <>                                                                   \
  struct IsMessage<const M> : TrueType {};                                      \
  template <>                                                                   \
  struct MD5Sum<M> {                                                            \
    static const char* value() { return desert_sim::GridMapType<M>::md5; }      \
    static const char* value(const M&) { return value(); }                      \
  };                                                                            \
  template <>                                                                   \
  struct DataType<M> {                                                          \
    static const char* value() { return desert_sim::GridMapType<M>::name; }     \
    static const char* value(const M&) { return value(); }                      \
  };                                                                            \
  template <>                                                                   \
  struct Definition<M> {                                                        \
    static const char* value() {                                                \
      static const std::string text = desert_sim::GridMapType<M>::definition(); \
      return text.c_str();                                                      \
    }                                                                           \
    static const char* value(const M&) { return value(); }                      \
  };

DESERT_GRID_MAP_MESSAGE(desert_sim::GridMap)
DESERT_GRID_MAP_MESSAGE(desert_sim::GetGridMapRequest)
DESERT_GRID_MAP_MESSAGE(desert_sim::GetGridMapResponse)
#undef DESERT_GRID_MAP_MESSAGE

}  // namespace message_traits

namespace service_traits {

#define DESERT_GRID_MAP_SERVICE(M)                                                               \
  template <>                                                                                    \
  struct MD5Sum<M> {                                                                             \
    static const char* value() { return desert_sim::GridMapType<desert_sim::GetGridMap>::md5; }  \
    static const char* value(const M&) { return value(); }                                       \
  };                                                                                             \
  template <>                                                                                    \
  struct DataType<M> {                                                                           \
    static const char* value() { return desert_sim::GridMapType<desert_sim::GetGridMap>::name; } \
    static const char* value(const M&) { return value(); }                                       \
  };

DESERT_GRID_MAP_SERVICE(desert_sim::GetGridMap)
#undef DESERT_GRID_MAP_SERVICE

}  // namespace service_traits

namespace serialization {

template <>
struct Serializer<desert_sim::GridMapInfo> {
  template <class Stream, class M>
  static void allInOne(Stream& stream, M m) {
    stream.next(m.header);
    stream.next(m.resolution);
    stream.next(m.length_x);
    stream.next(m.length_y);
    stream.next(m.pose);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<desert_sim::GridMap> {
  template <class Stream, class M>
  static void allInOne(Stream& stream, M m) {
    stream.next(m.info);
    stream.next(m.layers);
    stream.next(m.basic_layers);
    stream.next(m.data);
    stream.next(m.outer_start_index);
    stream.next(m.inner_start_index);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<desert_sim::GetGridMapRequest> {
  template <class Stream, class M>
  static void allInOne(Stream& stream, M m) {
    stream.next(m.frame_id);
    stream.next(m.position_x);
    stream.next(m.position_y);
    stream.next(m.length_x);
    stream.next(m.length_y);
    stream.next(m.layers);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<desert_sim::GetGridMapResponse> {
  template <class Stream, class M>
  static void allInOne(Stream& stream, M m) {
    stream.next(m.map);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

}  // namespace serialization
}  // namespace ros
