/// ~points and ~water_points: the surface, and that of the water, as coloured points.

#include <sensor_msgs/PointCloud2.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>
#include <cstring>

#include "src/render/terrain_colours.hpp"
#include "src/ros/conversion/messages.hpp"
#include "src/ros/conversion/surface_colour.hpp"
#include "src/ros/topics/topic_list.hpp"

namespace desert_sim {

namespace {

/// A point as it lies in the message: three coordinates, the colour, and two more fields that differ by
/// topic.
struct Point {
  float x, y, z;
  std::uint32_t rgb;  // 0x00RRGGBB, in a field of type float32, as rviz expects
  float extra[2];
};

sensor_msgs::PointCloud2Ptr empty_cloud(const TerrainState& state, const std::string& frame,
                                        const char* fifth, const char* sixth) {
  auto cloud = boost::make_shared<sensor_msgs::PointCloud2>();
  cloud->header = header_of(state.moment, frame);
  for (const char* name : {"x", "y", "z", "rgb", fifth, sixth}) {
    sensor_msgs::PointField field;
    field.name = name;
    field.offset = static_cast<std::uint32_t>(cloud->fields.size() * sizeof(float));
    field.datatype = sensor_msgs::PointField::FLOAT32;
    field.count = 1;
    cloud->fields.push_back(field);
  }
  static_assert(sizeof(Point) == 6 * sizeof(float), "fields follow each other without padding");
  cloud->point_step = sizeof(Point);
  const std::uint16_t one = 1;
  std::uint8_t first_byte;
  std::memcpy(&first_byte, &one, 1);
  cloud->is_bigendian = first_byte == 0;
  cloud->is_dense = true;
  return cloud;
}

void fill_cloud(sensor_msgs::PointCloud2& cloud, int columns, int rows, const std::vector<Point>& points) {
  cloud.width = static_cast<std::uint32_t>(columns);
  cloud.height = static_cast<std::uint32_t>(rows);
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.data.resize(points.size() * sizeof(Point));
  if (!points.empty()) std::memcpy(cloud.data.data(), points.data(), cloud.data.size());
}

std::uint32_t packed_rgb(const render::Colour& c) {
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

/// Samples every k-th cell in both directions, with the smallest k that leaves at most `count` points.
struct Sampling {
  int stride, columns, rows;

  Sampling(const Snapshot& s, int count)
      : stride(stride_for(s, count)),
        columns((s.width + stride - 1) / stride),
        rows((s.height + stride - 1) / stride) {}
  /// Calls visit(x, y, i) with the cell in the middle of each block of k × k cells and its index, row-major
  /// from the south-west.
  template <class Visit>
  void for_each(const Snapshot& s, const Visit& visit) const {
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const int x = std::min(column * stride + stride / 2, s.width - 1),
                  y = std::min(row * stride + stride / 2, s.height - 1);
        visit(x, y, static_cast<std::size_t>(y) * s.width + x);
      }
  }
};

Point point_at(const Snapshot& s, const ViewFrame& frame, int x, int y, double z,
               const render::Colour& colour, float fifth, float sixth) {
  return {static_cast<float>(s.origin_x + (x + 0.5) * s.cell_size - frame.x),
          static_cast<float>(s.origin_y + (y + 0.5) * s.cell_size - frame.y),
          static_cast<float>(z - frame.z),
          packed_rgb(colour),
          {fifth, sixth}};
}

float value(const std::vector<float>* layer, std::size_t i) { return layer ? (*layer)[i] : 0.0f; }

/// One row of the cloud for each row of samples. Fields, float32: x, y, z [m], rgb (the colour of the
/// material, lit from the west-north-west), sand [m], wind_shadow [0…1].
sensor_msgs::PointCloud2Ptr point_cloud(const TerrainState& state, const ViewFrame& frame, int count) {
  const Snapshot& s = *state.snapshot;
  const Sampling sampling(s, count);
  const SurfaceColour colour(s, sampling.stride / 2);
  const std::vector<float>& elevation = s.layers.at(Layer::elevation);
  const std::vector<float>*sand = s.find(Layer::sand), *shadow = s.find(Layer::wind_shadow);
  std::vector<Point> points;
  points.reserve(static_cast<std::size_t>(sampling.columns) * static_cast<std::size_t>(sampling.rows));
  sampling.for_each(s, [&](int x, int y, std::size_t i) {
    points.push_back(
        point_at(s, frame, x, y, elevation[i], colour.at(x, y), value(sand, i), value(shadow, i)));
  });
  const auto cloud = empty_cloud(state, frame.name, "sand", "wind_shadow");
  fill_cloud(*cloud, sampling.columns, sampling.rows, points);
  return cloud;
}

/// The surface of the water at those of the same samples that are under more than a centimetre of it, in the
/// same order, in a cloud of one row. Fields, float32: x, y, z [m], rgb (by depth), depth [m], speed [m/s].
sensor_msgs::PointCloud2Ptr water_cloud(const TerrainState& state, const ViewFrame& frame, int count) {
  constexpr float min_depth = 0.01f;  // [m]
  const Snapshot& s = *state.snapshot;
  const std::vector<float>& elevation = s.layers.at(Layer::elevation);
  const std::vector<float>*water = s.find(Layer::water), *u = s.find(Layer::water_velocity_x),
        *v = s.find(Layer::water_velocity_y);
  std::vector<Point> points;
  if (water)
    Sampling(s, count).for_each(s, [&](int x, int y, std::size_t i) {
      const float depth = (*water)[i];
      if (depth <= min_depth) return;
      points.push_back(point_at(s, frame, x, y, elevation[i] + depth, render::water_colour(depth, s.palette),
                                depth, std::hypot(value(u, i), value(v, i))));
    });
  const auto cloud = empty_cloud(state, frame.name, "depth", "speed");
  fill_cloud(*cloud, static_cast<int>(points.size()), 1, points);
  return cloud;
}

class PointsTopic : public MessageTopic<sensor_msgs::PointCloud2> {
 public:
  explicit PointsTopic(const TopicContext& context) : MessageTopic(context, "points") {}
  double rate() const override { return parameters().topics.points_rate; }
  std::vector<Layer> layers() const override {
    return {Layer::elevation, Layer::sand,       Layer::wind_shadow, Layer::soil,
            Layer::water,     Layer::vegetation, Layer::plants,      Layer::obstacle};
  }
  bool publish(const TerrainState& state) override {
    publisher_.publish(point_cloud(state, view_frame(), parameters().topics.points_count));
    return true;
  }
};

class WaterPointsTopic : public MessageTopic<sensor_msgs::PointCloud2> {
 public:
  explicit WaterPointsTopic(const TopicContext& context) : MessageTopic(context, "water_points") {}
  double rate() const override { return parameters().topics.water_points_rate; }
  std::vector<Layer> layers() const override {
    return {Layer::elevation, Layer::water, Layer::water_velocity_x, Layer::water_velocity_y};
  }
  bool publish(const TerrainState& state) override {
    publisher_.publish(water_cloud(state, view_frame(), parameters().topics.points_count));
    return true;
  }
};

}  // namespace

void add_points_topics(const TopicContext& context, TopicList& topics) {
  topics.push_back(std::make_unique<PointsTopic>(context));
  topics.push_back(std::make_unique<WaterPointsTopic>(context));
}

}  // namespace desert_sim
