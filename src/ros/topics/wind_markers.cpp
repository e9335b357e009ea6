#include "src/ros/topics/wind_markers.hpp"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <limits>

#include "src/ros/conversion/messages.hpp"

namespace desert_sim {

namespace {

using visualization_msgs::Marker;

/// `relative`: speed over that of the wind above.
std_msgs::ColorRGBA speed_colour(double relative) {
  // Half as fast or less: blue. As fast: near white. Half as fast again or more: red.
  constexpr float stops[3][3] = {{0.10f, 0.25f, 0.85f}, {0.92f, 0.97f, 1.0f}, {0.95f, 0.15f, 0.10f}};
  const double place = std::clamp(2 * (relative - 0.5), 0.0, 2.0);
  const int n = place < 1 ? 0 : 1;
  const float f = static_cast<float>(place - n);
  const auto channel = [&](int c) { return stops[n][c] + f * (stops[n + 1][c] - stops[n][c]); };
  std_msgs::ColorRGBA colour;
  colour.r = channel(0);
  colour.g = channel(1);
  colour.b = channel(2);
  colour.a = 1;
  return colour;
}

Marker base(const TerrainState& state, const std::string& frame, const char* space, int id, int type) {
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

Marker clock(const TerrainState& state, const std::string& frame) {
  const Snapshot& s = *state.snapshot;
  const std::vector<float>& z = s.layers.at(Layer::elevation);
  const double width = s.width * s.cell_size, height = s.height * s.cell_size,
               size = 0.04 * std::max(width, height);
  Marker m = base(state, frame, "clock", 0, Marker::TEXT_VIEW_FACING);
  m.text = clock_text(s);
  m.pose.position.x = s.origin_x + 0.5 * width;
  m.pose.position.y = s.origin_y + height;
  m.pose.position.z = *std::max_element(z.begin(), z.end()) + 2 * size;
  m.scale.z = size;
  m.color.r = m.color.g = m.color.b = 1;
  return m;
}

/// Arrows of the wind at cells, `reach` metres apart.
class Arrows {
 public:
  Arrows(const Snapshot& s, double reach)
      : s_(s),
        reach_(reach),
        z_(s.layers.at(Layer::elevation)),
        water_(s.find(Layer::water)),
        u_(s.find(Layer::wind_x)),
        v_(s.find(Layer::wind_y)) {
    const double above = std::hypot(s.wind_above.x, s.wind_above.y);
    reference_ = above > 0.1 ? above : 1.0;
  }

  void place(Marker& m, int x, int y) const {
    const std::size_t i = static_cast<std::size_t>(y) * s_.width + x;
    const double wind_x = u_ ? (*u_)[i] : 0.0, wind_y = v_ ? (*v_)[i] : 0.0,
                 speed = std::hypot(wind_x, wind_y);
    const double yaw = std::atan2(wind_y, wind_x);
    m.scale.x = reach_ * std::clamp(0.75 * speed / reference_, 0.02, 1.5);
    m.scale.y = m.scale.z = 0.09 * reach_;
    m.pose.position.x = s_.origin_x + (x + 0.5) * s_.cell_size;
    m.pose.position.y = s_.origin_y + (y + 0.5) * s_.cell_size;
    m.pose.position.z = highest_below(x, y, yaw, m.scale.x) + 0.2 * reach_;
    m.pose.orientation.z = std::sin(0.5 * yaw);
    m.pose.orientation.w = std::cos(0.5 * yaw);
    m.color = speed_colour(speed / reference_);
  }

 private:
  /// So that neither a slope nor water hides the arrow.
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
  const double reach_;
  double reference_;  ///< speed above [m/s]
  const std::vector<float>&z_, *water_, *u_, *v_;
};

}  // namespace

const std::vector<Layer>& wind_marker_layers() {
  static const std::vector<Layer> layers{Layer::elevation, Layer::water, Layer::wind_x, Layer::wind_y};
  return layers;
}

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

visualization_msgs::MarkerArrayPtr WindMarkers::markers(const TerrainState& state, int count) {
  const Snapshot& s = *state.snapshot;
  int spacing = 1;  // cells
  while (static_cast<std::int64_t>(std::max(1, s.width / spacing)) * std::max(1, s.height / spacing) > count)
    ++spacing;
  const int columns = std::max(1, s.width / spacing), rows = std::max(1, s.height / spacing);
  auto array = boost::make_shared<visualization_msgs::MarkerArray>();
  if (columns != columns_ || rows != rows_) {
    Marker all = base(state, frame_, "wind", 0, Marker::ARROW);
    all.action = Marker::DELETEALL;
    array->markers.push_back(all);
  }
  columns_ = columns;
  rows_ = rows;

  const Arrows arrows(s, spacing * s.cell_size);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      Marker m = base(state, frame_, "wind", row * columns + column, Marker::ARROW);
      arrows.place(m, (2 * column + 1) * s.width / (2 * columns), (2 * row + 1) * s.height / (2 * rows));
      array->markers.push_back(m);
    }
  array->markers.push_back(clock(state, frame_));
  return array;
}

}  // namespace desert_sim
