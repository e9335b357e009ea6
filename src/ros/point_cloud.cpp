#include "desert_sim/ros/point_cloud.hpp"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>
#include <cstring>

#include "desert_sim/ros/messages.hpp"
#include "desert_sim/ros/surface_colour.hpp"

namespace desert_sim {

namespace {

/// As it lies in the message.
struct Point {
  float x, y, z;
  std::uint32_t rgb;  // 0x00RRGGBB, in a field that says float32
  float sand, wind_shadow;
};

void describe_fields(sensor_msgs::PointCloud2& cloud) {
  for (const char* name : {"x", "y", "z", "rgb", "sand", "wind_shadow"}) {
    sensor_msgs::PointField field;
    field.name = name;
    field.offset = static_cast<std::uint32_t>(cloud.fields.size() * sizeof(float));
    field.datatype = sensor_msgs::PointField::FLOAT32;
    field.count = 1;
    cloud.fields.push_back(field);
  }
  static_assert(sizeof(Point) == 6 * sizeof(float), "fields lie one behind the other");
  cloud.point_step = sizeof(Point);
  const std::uint16_t one = 1;
  std::uint8_t first_byte;
  std::memcpy(&first_byte, &one, 1);
  cloud.is_bigendian = first_byte == 0;
  cloud.is_dense = true;
}

std::uint32_t packed(const Colour& c) {
  const auto byte = [](float v) { return static_cast<std::uint32_t>(std::lround(255.0f * v)); };
  return byte(c.r) << 16 | byte(c.g) << 8 | byte(c.b);
}

int stride_for(const Snapshot& s, int count) {
  int stride = 1;
  const auto points = [&](int k) {
    return static_cast<std::int64_t>((s.width + k - 1) / k) *
           static_cast<std::int64_t>((s.height + k - 1) / k);
  };
  while (points(stride) > count) ++stride;
  return stride;
}

}  // namespace

const std::vector<Layer>& point_layers() {
  static const std::vector<Layer> layers{Layer::elevation, Layer::sand,       Layer::wind_shadow, Layer::soil,
                                         Layer::water,     Layer::vegetation, Layer::obstacle};
  return layers;
}

sensor_msgs::PointCloud2Ptr point_cloud(const TerrainState& state, const std::string& frame, int count) {
  const Snapshot& s = *state.snapshot;
  const int stride = stride_for(s, count);
  const int columns = (s.width + stride - 1) / stride, rows = (s.height + stride - 1) / stride;
  auto cloud = boost::make_shared<sensor_msgs::PointCloud2>();
  cloud->header = header_of(state.moment, frame);
  describe_fields(*cloud);
  cloud->width = static_cast<std::uint32_t>(columns);
  cloud->height = static_cast<std::uint32_t>(rows);
  cloud->row_step = cloud->width * cloud->point_step;
  cloud->data.resize(static_cast<std::size_t>(cloud->row_step) * cloud->height);

  const SurfaceColour colour(s, stride / 2);
  const std::vector<float>& elevation = s.layers.at(Layer::elevation);
  const std::vector<float>*sand = s.find(Layer::sand), *shadow = s.find(Layer::wind_shadow);
  std::uint8_t* to = cloud->data.data();
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column, to += sizeof(Point)) {
      const int x = std::min(column * stride + stride / 2, s.width - 1),
                y = std::min(row * stride + stride / 2, s.height - 1);
      const std::size_t i = static_cast<std::size_t>(y) * s.width + x;
      const Point point{static_cast<float>(s.origin_x + (x + 0.5) * s.cell_size),
                        static_cast<float>(s.origin_y + (y + 0.5) * s.cell_size),
                        elevation[i],
                        packed(colour.at(x, y)),
                        sand ? (*sand)[i] : 0.0f,
                        shadow ? (*shadow)[i] : 0.0f};
      std::memcpy(to, &point, sizeof point);
    }
  return cloud;
}

}  // namespace desert_sim
