/// ~wind_markers: arrows of the wind at the surface, and the simulation's clock as a text, for rviz.

#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <limits>

#include "src/render/terrain_colours.hpp"
#include "src/ros/conversion/messages.hpp"
#include "src/ros/topics/topic_list.hpp"

namespace desert_sim {

namespace {

using visualization_msgs::Marker;

std_msgs::ColorRGBA speed_colour(double relative) {
  const render::Colour c = render::wind_colour(static_cast<float>(relative));
  std_msgs::ColorRGBA colour;
  colour.r = c.r;
  colour.g = c.g;
  colour.b = c.b;
  colour.a = 1;
  return colour;
}

Marker base_marker(const TerrainState& state, const std::string& frame, const char* space, int id, int type) {
  Marker m;
  m.header = header_of(state.moment, frame);
  m.ns = space;
  m.id = id;
  m.type = type;
  m.action = Marker::ADD;
  m.pose.orientation.w = 1;
  m.color.a = 1;
  return m;
}

/// The clock as a text, such as "1 d 02:03:04   step 93784   wind 5.0 m/s to 90 deg".
std::string clock_text(const Snapshot& s) {
  const auto seconds = static_cast<std::uint64_t>(s.time);
  double speed, direction;
  speed_and_direction(s.wind_above, speed, direction);
  char days[32] = "", text[160];
  if (seconds >= 86400) std::snprintf(days, sizeof days, "%" PRIu64 " d ", seconds / 86400);
  std::snprintf(text, sizeof text, "%s%02d:%02d:%02d   step %" PRIu64 "   wind %.1f m/s to %.0f deg", days,
                static_cast<int>(seconds / 3600 % 24), static_cast<int>(seconds / 60 % 60),
                static_cast<int>(seconds % 60), s.step, speed, direction);
  return text;
}

Marker clock_marker(const TerrainState& state, const ViewFrame& frame) {
  const Snapshot& s = *state.snapshot;
  const std::vector<float>& z = s.layers.at(Layer::elevation);
  const double width = s.width * s.cell_size, height = s.height * s.cell_size,
               size = 0.04 * std::max(width, height);
  Marker m = base_marker(state, frame.name, "clock", 0, Marker::TEXT_VIEW_FACING);
  m.text = clock_text(s);
  m.pose.position.x = s.origin_x + 0.5 * width - frame.x;
  m.pose.position.y = s.origin_y + height - frame.y;
  m.pose.position.z = *std::max_element(z.begin(), z.end()) + 2 * size - frame.z;
  m.scale.z = size;
  m.color.r = m.color.g = m.color.b = 1;
  return m;
}

/// Places arrows of the wind on cells that are `spacing` metres apart.
class Arrows {
 public:
  Arrows(const Snapshot& s, const ViewFrame& frame, double spacing)
      : s_(s),
        frame_(frame),
        spacing_(spacing),
        z_(s.layers.at(Layer::elevation)),
        water_(s.find(Layer::water)),
        u_(s.find(Layer::wind_x)),
        v_(s.find(Layer::wind_y)) {
    const double above = std::hypot(s.wind_above.x, s.wind_above.y);
    reference_ = above > 0.1 ? above : 1.0;
  }

  void set_arrow(Marker& m, int x, int y) const {
    const std::size_t i = static_cast<std::size_t>(y) * s_.width + x;
    const double wind_x = u_ ? (*u_)[i] : 0.0, wind_y = v_ ? (*v_)[i] : 0.0,
                 speed = std::hypot(wind_x, wind_y);
    const double yaw = std::atan2(wind_y, wind_x);
    m.scale.x = spacing_ * std::clamp(0.75 * speed / reference_, 0.02, 1.5);
    m.scale.y = m.scale.z = 0.09 * spacing_;
    m.pose.position.x = s_.origin_x + (x + 0.5) * s_.cell_size - frame_.x;
    m.pose.position.y = s_.origin_y + (y + 0.5) * s_.cell_size - frame_.y;
    m.pose.position.z = highest_below(x, y, yaw, m.scale.x) + 0.2 * spacing_ - frame_.z;
    m.pose.orientation.z = std::sin(0.5 * yaw);
    m.pose.orientation.w = std::cos(0.5 * yaw);
    m.color = speed_colour(speed / reference_);
  }

 private:
  /// The highest surface, water included, under an arrow from a cell: it is drawn above that, so that neither
  /// a slope nor water hides it [m].
  double highest_below(int x, int y, double yaw, double length) const {
    constexpr int samples = 4;
    double highest = -std::numeric_limits<double>::infinity();
    for (int n = 0; n <= samples; ++n) {
      const double cells = n * length / (samples * s_.cell_size);
      const int ix = std::clamp(x + static_cast<int>(std::lround(cells * std::cos(yaw))), 0, s_.width - 1);
      const int iy = std::clamp(y + static_cast<int>(std::lround(cells * std::sin(yaw))), 0, s_.height - 1);
      const std::size_t i = static_cast<std::size_t>(iy) * s_.width + ix;
      highest = std::max(highest, static_cast<double>(z_[i] + (water_ ? (*water_)[i] : 0.0f)));
    }
    return highest;
  }

  const Snapshot& s_;
  const ViewFrame& frame_;
  const double spacing_;
  double reference_;  ///< speed of the high-altitude wind; 1 in a calm [m/s]
  const std::vector<float>&z_, *water_, *u_, *v_;
};

/// Arrows are in the namespace "wind" with ids 0… by rows from the south-west, the text "clock" has id 0 and
/// stands above the north edge. An arrow of the high-altitude wind's speed nearly reaches the next one.
class WindMarkersTopic : public MessageTopic<visualization_msgs::MarkerArray> {
 public:
  explicit WindMarkersTopic(const TopicContext& context) : MessageTopic(context, "wind_markers") {}
  double rate() const override { return parameters().topics.wind_markers_rate; }
  std::vector<Layer> layers() const override {
    return {Layer::elevation, Layer::water, Layer::wind_x, Layer::wind_y};
  }
  bool publish(const TerrainState& state) override {
    publisher_.publish(markers(state, parameters().topics.wind_markers_count));
    return true;
  }

 private:
  /// At most `count` arrows, and the clock. When the number of arrows has changed, the old ones are deleted
  /// first.
  visualization_msgs::MarkerArrayPtr markers(const TerrainState& state, int count) {
    const Snapshot& s = *state.snapshot;
    const ViewFrame frame = view_frame();
    int spacing = 1;  // cells
    while (static_cast<std::int64_t>(std::max(1, s.width / spacing)) * std::max(1, s.height / spacing) >
           count)
      ++spacing;
    const int columns = std::max(1, s.width / spacing), rows = std::max(1, s.height / spacing);
    auto array = boost::make_shared<visualization_msgs::MarkerArray>();
    if (columns != columns_ || rows != rows_) {
      Marker all = base_marker(state, frame.name, "wind", 0, Marker::ARROW);
      all.action = Marker::DELETEALL;
      array->markers.push_back(all);
    }
    columns_ = columns;
    rows_ = rows;

    const Arrows arrows(s, frame, spacing * s.cell_size);
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        Marker m = base_marker(state, frame.name, "wind", row * columns + column, Marker::ARROW);
        arrows.set_arrow(m, (2 * column + 1) * s.width / (2 * columns),
                         (2 * row + 1) * s.height / (2 * rows));
        array->markers.push_back(m);
      }
    array->markers.push_back(clock_marker(state, frame));
    return array;
  }

  int columns_ = 0, rows_ = 0;  ///< of the arrows that were published last
};

}  // namespace

void add_wind_markers_topic(const TopicContext& context, TopicList& topics) {
  topics.push_back(std::make_unique<WindMarkersTopic>(context));
}

}  // namespace desert_sim
