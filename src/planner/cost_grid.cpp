#include "src/planner/cost_grid.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "src/core/elementary.hpp"
#include "src/core/error.hpp"
#include "src/core/host_memory.hpp"
#include "src/core/number_text.hpp"

namespace desert_sim {

namespace {

constexpr double most_near = 40;     // cells of a radius, so that counts fit 16 bits
constexpr int largest_side = 16384;  // [cells]

void require(double value, double lowest, double highest, const char* what) {
  if (value >= lowest && value <= highest) return;
  std::ostringstream text;
  text << what << ": " << value << " (allowed: " << lowest << " ... " << highest << ")";
  throw ConfigError(text.str());
}

/// For a grid and the field of a planner on it.
void require_memory(const GridFrame& frame) {
  constexpr double bytes_per_cell = 32;
  const double bytes = bytes_per_cell * frame.width * frame.height;
  const auto available = static_cast<double>(host_memory_available());
  if (bytes > available)
    throw ConfigError("planning on " + std::to_string(frame.width) + " x " + std::to_string(frame.height) +
                      " cells takes " + number_text(bytes / 1073741824.0) +
                      " GiB of memory; available: " + number_text(available / 1073741824.0) + " GiB");
}

}  // namespace

CostGrid::CostGrid(const GridFrame& frame, const CostParameters& p) : frame_(frame), parameters_(p) {
  require(frame.width, 1, largest_side, "width");
  require(frame.height, 1, largest_side, "height");
  require(frame.cell_size, 1e-6, 1e6, "cell_size");
  require(p.buckets, 1, 100, "buckets");
  require(p.weight, 0, 60, "weight");
  require(p.lethal_below, 0, 0.99, "lethal_below");
  require(p.radius, 0, most_near * frame.cell_size, "radius");
  require_memory(frame);
  for (int b = 0; b < p.buckets; ++b) {
    const double share = (b + 0.5) / p.buckets;
    by_bucket_.push_back(static_cast<std::uint8_t>(std::lround(cheapest * (1 + p.weight * share * share))));
  }
  by_bucket_.front() = cheapest;  // the heuristic of the planners counts on it
  near_ = disc(std::max(p.radius, frame.cell_size));
  const std::size_t cells =
      static_cast<std::size_t>(frame.width + 2) * static_cast<std::size_t>(frame.height + 2);
  own_.assign(cells, lethal);
  lethal_near_.assign(cells, static_cast<std::uint16_t>(near_.size()));
  marks_.assign(cells, 0);
  costs_.assign(cells, lethal);
}

std::vector<CostGrid::Offset> CostGrid::disc(double radius) const {
  std::vector<Offset> offsets;
  const double cells = radius / frame_.cell_size;
  const int reach = static_cast<int>(cells);
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x)
      if (x * x + y * y <= cells * cells) offsets.push_back({x, y});
  return offsets;
}

template <class Visit>
void CostGrid::for_each_within(double radius, CellIndex c, const Visit& visit) const {
  const int cx = x_of(c), cy = y_of(c);
  const double cells = radius / frame_.cell_size;
  const int reach = static_cast<int>(std::min(cells, 2.0 * largest_side));
  for (int y = std::max(-reach, -cy); y <= std::min(reach, frame_.height - 1 - cy); ++y)
    for (int x = std::max(-reach, -cx); x <= std::min(reach, frame_.width - 1 - cx); ++x)
      if (static_cast<double>(x) * x + static_cast<double>(y) * y <= cells * cells)
        visit(cell(cx + x, cy + y));
}

template <class Visit>
void CostGrid::for_each_in(const std::vector<Offset>& disc, CellIndex c, const Visit& visit) const {
  const int cx = x_of(c), cy = y_of(c);
  for (const Offset& o : disc) {
    const int x = cx + o.x, y = cy + o.y;
    if (x >= 0 && x < frame_.width && y >= 0 && y < frame_.height) visit(cell(x, y));
  }
}

void CostGrid::spread(CellIndex c, bool now_lethal, std::vector<CellIndex>& changed) {
  for_each_in(near_, c, [&](CellIndex other) {
    lethal_near_[other] = static_cast<std::uint16_t>(lethal_near_[other] + (now_lethal ? 1 : -1));
    refresh(other, changed);
  });
}

void CostGrid::refresh(CellIndex c, std::vector<CellIndex>& changed) {
  const std::uint8_t cost = lethal_near_[c] > 0 ? lethal : own_[c];
  if (cost == costs_[c]) return;
  costs_[c] = cost;
  changed.push_back(c);
}

void CostGrid::update(const Box& box, const float* traversability, std::vector<CellIndex>& changed) {
  if (box.x < 0 || box.y < 0 || box.width < 0 || box.height < 0 || box.x + box.width > frame_.width ||
      box.y + box.height > frame_.height)
    throw ConfigError("a box of costs exceeds the grid");
  for (int y = box.y; y < box.y + box.height; ++y)
    for (int x = box.x; x < box.x + box.width; ++x) {
      const CellIndex c = cell(x, y);
      const std::uint8_t cost = cost_of(*traversability++);
      if (cost == own_[c]) continue;
      const bool was = itself_lethal(c);
      own_[c] = cost;
      const bool is = itself_lethal(c);
      if (was != is)
        spread(c, is, changed);
      else
        refresh(c, changed);
    }
}

void CostGrid::mark(const GridPoint& p, double radius, bool set, std::vector<CellIndex>& changed) {
  const auto middle = cell_at(p);
  if (!middle) return;
  for_each_within(radius, *middle, [&](CellIndex c) {
    const bool was = itself_lethal(c);
    if (!set && marks_[c] == 0) return;
    marks_[c] = static_cast<std::uint16_t>(marks_[c] + (set ? 1 : -1));
    if (itself_lethal(c) != was) spread(c, !was, changed);
  });
}

std::optional<CellIndex> CostGrid::nearest_passable(const GridPoint& p, double distance) const {
  const auto middle = cell_at(p);
  if (!middle) return std::nullopt;
  std::optional<CellIndex> best;
  double nearest = 0;
  for_each_within(distance, *middle, [&](CellIndex c) {
    if (costs_[c] == lethal) return;
    const GridPoint q = centre(c);
    const double away = elementary::hypot(q.x - p.x, q.y - p.y);
    if (!best || away < nearest) best = c, nearest = away;
  });
  return best;
}

std::optional<CellIndex> CostGrid::cell_at(const GridPoint& p) const {
  const double x = std::floor((p.x - frame_.origin_x) / frame_.cell_size),
               y = std::floor((p.y - frame_.origin_y) / frame_.cell_size);
  if (!(x >= 0 && x < frame_.width && y >= 0 && y < frame_.height)) return std::nullopt;
  return cell(static_cast<int>(x), static_cast<int>(y));
}

GridPoint CostGrid::centre(CellIndex c) const {
  return {frame_.origin_x + (x_of(c) + 0.5) * frame_.cell_size,
          frame_.origin_y + (y_of(c) + 0.5) * frame_.cell_size};
}

std::uint8_t CostGrid::cost_of(float t) const {
  if (!(t > static_cast<float>(parameters_.lethal_below))) return lethal;
  const int bucket = static_cast<int>((1 - t) * static_cast<float>(parameters_.buckets));
  return by_bucket_[static_cast<std::size_t>(std::clamp(bucket, 0, parameters_.buckets - 1))];
}

}  // namespace desert_sim
