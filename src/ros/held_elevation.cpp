#include "desert_sim/ros/held_elevation.hpp"

#include <algorithm>
#include <cmath>

#include "desert_sim/client/elevation_tile.hpp"

namespace desert_sim {

namespace {

/// The largest change that so many bits tell, in steps.
constexpr int most_steps(int bits) { return (1 << (bits - 1)) - 1; }

/// Whether some cells of a row may differ: a loop that compilers make vectors of. Unknown cells may.
bool some_differ(const float* now, const float* held, int cells, float threshold) {
  int some = 0;
  for (int n = 0; n < cells; ++n) some |= !(std::abs(now[n] - held[n]) <= threshold);
  return some != 0;
}

}  // namespace

void HeldElevation::configure(double threshold, int tile) {
  threshold_ = static_cast<float>(threshold);
  tile_ = tile;
}

void HeldElevation::hold(const Snapshot& snapshot) {
  width_ = snapshot.width;
  height_ = snapshot.height;
  held_ = snapshot.layers.at(Layer::elevation);
}

void HeldElevation::forget() {
  width_ = height_ = 0;
  held_ = std::vector<float>();
}

bool HeldElevation::holds(const Snapshot& snapshot) const {
  return !held_.empty() && width_ == snapshot.width && height_ == snapshot.height;
}

bool HeldElevation::differs(float now, float held) const {
  return !(std::abs(now - held) <= threshold_) && !(std::isnan(now) && std::isnan(held));
}

CellBox HeldElevation::differing(const std::vector<float>& now, const CellBox& cells) const {
  CellBox found;
  for (int y = cells.y0; y < cells.y1; ++y) {
    const std::size_t first = row(y) + static_cast<std::size_t>(cells.x0);
    if (!some_differ(&now[first], &held_[first], cells.width(), threshold_)) continue;
    int x0 = cells.x0, x1 = cells.x1;
    while (x0 < x1 && !differs(now[row(y) + x0], held_[row(y) + x0])) ++x0;
    while (x0 < x1 && !differs(now[row(y) + x1 - 1], held_[row(y) + x1 - 1])) --x1;
    found = found.with({x0, y, x1, y + 1});
  }
  return found;
}

ElevationTile HeldElevation::take(const std::vector<float>& now, const CellBox& cells) {
  ElevationTile tile;
  tile.x = static_cast<std::uint32_t>(cells.x0);
  tile.y = static_cast<std::uint32_t>(cells.y0);
  tile.width = static_cast<std::uint32_t>(cells.width());
  tile.height = static_cast<std::uint32_t>(cells.height());
  const std::size_t count = static_cast<std::size_t>(tile.width) * tile.height;
  tile.changed.resize(mask_bytes(count), 0);
  std::vector<std::size_t> changed;
  float largest = 0;
  bool known = true;  // before and now
  std::size_t n = 0;
  for (int y = cells.y0; y < cells.y1; ++y)
    for (std::size_t i = row(y) + cells.x0; i < row(y) + cells.x1; ++i, ++n) {
      if (!differs(now[i], held_[i])) continue;
      mask_add(tile.changed, n);
      changed.push_back(i);
      const float change = std::abs(now[i] - held_[i]);
      known = known && !std::isnan(change);
      largest = std::max(largest, change);
    }
  if (changed.size() == count) tile.changed.clear();
  // Half a step is the largest error; a little less than the threshold, so that rounding does not exceed it.
  const auto tells = [&](int bits) { return known && largest / most_steps(bits) <= 1.99f * threshold_; };
  const int bits = tells(4) ? 4 : (tells(8) ? 8 : 0);
  if (bits == 0) {
    for (const std::size_t i : changed) tile.data.push_back(held_[i] = now[i]);
    return tile;
  }
  tile.bits = static_cast<std::uint8_t>(bits);
  tile.resolution = largest / most_steps(bits);
  for (std::size_t k = 0; k < changed.size(); ++k) {
    float& held = held_[changed[k]];
    const long steps = std::lround((now[changed[k]] - held) / tile.resolution), most = most_steps(bits);
    change_add(tile.changes, bits, k, static_cast<int>(std::clamp(steps, -most, most)));
    held = changed_elevation(held, change_at(tile.changes, bits, k), tile.resolution);
  }
  return tile;
}

std::vector<ElevationTile> HeldElevation::take_changes(const Snapshot& snapshot) {
  const std::vector<float>& now = snapshot.layers.at(Layer::elevation);
  std::vector<ElevationTile> changes;
  for (int y = 0; y < height_; y += tile_)
    for (int x = 0; x < width_; x += tile_) {
      const CellBox cells =
          differing(now, {x, y, std::min(width_ - x, tile_) + x, std::min(height_ - y, tile_) + y});
      if (!cells.empty()) changes.push_back(take(now, cells));
    }
  return changes;
}

}  // namespace desert_sim
