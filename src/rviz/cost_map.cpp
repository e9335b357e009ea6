#include "src/rviz/cost_map.hpp"

#include <cmath>

#include "src/core/error.hpp"
#include "src/core/number_text.hpp"
#include "src/render/drawable.hpp"

namespace desert_sim {

namespace {

std::string size_text(std::uint32_t width, std::uint32_t height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace

CostMap::CostMap(const nav_msgs::OccupancyGrid& m)
    : frame(m.header.frame_id), cell_size(static_cast<double>(m.info.resolution)) {
  const std::uint32_t w = m.info.width, h = m.info.height;
  if (w < 1 || h < 1 || w > most_cells || h > most_cells)
    throw ConfigError("a map of " + size_text(w, h) + " cells cannot be drawn (allowed: 1 ... " +
                      std::to_string(most_cells) + " on a side)");
  if (m.data.size() != static_cast<std::size_t>(w) * h)
    throw ConfigError("a map of " + size_text(w, h) + " cells has " + std::to_string(m.data.size()) +
                      " costs");
  if (!(cell_size > 0) || !render::is_drawable(cell_size * std::max(w, h)))
    throw ConfigError("a map's resolution is " + number_text(cell_size) + " m (allowed: above 0)");
  const auto& p = m.info.origin.position;
  const auto& q = m.info.origin.orientation;
  const double norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!render::is_drawable(p.x) || !render::is_drawable(p.y) || !render::is_drawable(p.z))
    throw ConfigError("a map's origin " + point_text(p.x, p.y) + " is no place");
  if (!(std::abs(norm - 1) < 0.01))
    throw ConfigError("the length of the quaternion of a map's origin is " + number_text(norm) +
                      " (allowed: 1)");
  corner = tf2::Transform(tf2::Quaternion(q.x, q.y, q.z, q.w).normalized(), {p.x, p.y, p.z});
  width = static_cast<int>(w);
  height = static_cast<int>(h);
  costs = m.data;
}

render::CellRectangle CostMap::update(const map_msgs::OccupancyGridUpdate& m) {
  if (costs.empty()) throw ConfigError("an update came before the first map");
  const bool inside = m.x >= 0 && m.y >= 0 && m.width <= static_cast<std::uint32_t>(width) &&
                      m.height <= static_cast<std::uint32_t>(height) &&
                      m.x <= width - static_cast<int>(m.width) && m.y <= height - static_cast<int>(m.height);
  if (!inside || m.data.size() != static_cast<std::size_t>(m.width) * m.height)
    throw ConfigError("an update of " + size_text(m.width, m.height) + " cells at (" + std::to_string(m.x) +
                      ", " + std::to_string(m.y) + ") with " + std::to_string(m.data.size()) +
                      " costs is not one of a map of " + std::to_string(width) + " x " +
                      std::to_string(height) + " cells");
  auto row = m.data.begin();
  for (std::uint32_t n = 0; n < m.height; ++n, row += m.width)
    std::copy(row, row + m.width, costs.begin() + (m.y + static_cast<int>(n)) * std::ptrdiff_t{width} + m.x);
  return {m.x, m.y, static_cast<int>(m.width), static_cast<int>(m.height)};
}

void CostMapInbox::subscribe(ros::NodeHandle& node, const std::string& topic) {
  unsubscribe();
  maps_ = node.subscribe<nav_msgs::OccupancyGrid>(
      topic, 1, [this](const nav_msgs::OccupancyGridConstPtr& message) { receive(*message); });
  updates_ = node.subscribe<map_msgs::OccupancyGridUpdate>(
      topic + "_updates", 100,
      [this](const map_msgs::OccupancyGridUpdateConstPtr& message) { receive(*message); });
}

void CostMapInbox::unsubscribe() {
  maps_.shutdown();  // waits for a callback that runs
  updates_.shutdown();
  const std::lock_guard<std::mutex> lock(mutex_);
  map_ = {};
  changed_ = {};
  replaced_ = false;
  report_ = {};
}

CostMapInbox::Report CostMapInbox::report() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return report_;
}

void CostMapInbox::receive(const nav_msgs::OccupancyGrid& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  try {
    map_ = CostMap(message);
    changed_ = map_.all();
    replaced_ = true;
    ++report_.maps;
    report_.problem.clear();
  } catch (const ConfigError& error) {
    report_.problem = error.what();
  }
}

void CostMapInbox::receive(const map_msgs::OccupancyGridUpdate& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  try {
    changed_.include(map_.update(message));
    ++report_.updates;
  } catch (const ConfigError& error) {
    if (!map_.costs.empty()) report_.problem = error.what();  // else the map is still to come
  }
}

void CostMapInbox::take(const Visit& visit) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (changed_.empty()) return;
  visit(map_, changed_, replaced_);
  changed_ = {};
  replaced_ = false;
}

}  // namespace desert_sim
