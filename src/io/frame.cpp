#include "src/io/frame.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "src/core/log.hpp"
#include "src/io/raster_geometry.hpp"

namespace desert_sim {

namespace {

constexpr double least_share = 0.25;   // of the outermost cells in a frame, and of all cells beside it
constexpr double share_of_part = 0.1;  // of the outermost cells in a part of a frame
constexpr float least_step = 1;        // [m]
constexpr float least_ratio = 20;      // of the step to those elsewhere

float median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The cells of a raster and their four neighbours.
class Cells {
 public:
  explicit Cells(const Raster& r) : r_(r) {}
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * r_.width + x; }

  /// visit(cell, side) for all on each of the four sides.
  template <class Visit>
  void each_outermost(const Visit& visit) const {
    for (int x = 0; x < r_.width; ++x) {
      visit(index(x, 0), 0);
      visit(index(x, r_.height - 1), 1);
    }
    for (int y = 0; y < r_.height; ++y) {
      visit(index(0, y), 2);
      visit(index(r_.width - 1, y), 3);
    }
  }

  template <class Visit>
  void each_neighbour(std::size_t i, const Visit& visit) const {
    const int x = static_cast<int>(i % r_.width), y = static_cast<int>(i / r_.width);
    if (x > 0) visit(i - 1);
    if (x + 1 < r_.width) visit(i + 1);
    if (y > 0) visit(i - r_.width);
    if (y + 1 < r_.height) visit(i + r_.width);
  }

 private:
  const Raster& r_;
};

/// The most frequent value of the outermost cells, if enough of them have it, and some on each side unless
/// the raster is a part.
std::optional<float> value_of_edge(const Raster& r, const Cells& cells, bool part) {
  struct Count {
    long long cells = 0;
    bool sides[4] = {};
  };
  std::map<float, Count> counts;
  cells.each_outermost([&](std::size_t i, int side) {
    if (!std::isfinite(r.values[i])) return;
    Count& count = counts[r.values[i]];
    ++count.cells;
    count.sides[side] = true;
  });
  const auto most = std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) {
    return a.second.cells < b.second.cells;
  });
  if (most == counts.end()) return std::nullopt;
  const Count& count = most->second;
  const double all = 2.0 * (r.width + r.height);
  const bool on_all_sides = std::all_of(count.sides, count.sides + 4, [](bool side) { return side; });
  if (static_cast<double>(count.cells) < (part ? share_of_part : least_share) * all ||
      (!part && !on_all_sides))
    return std::nullopt;
  return most->first;
}

}  // namespace

std::optional<Frame> find_frame(const Raster& r, bool part) {
  const Cells cells(r);
  const std::optional<float> value = value_of_edge(r, cells, part);
  if (!value) return std::nullopt;
  std::vector<bool> in_frame(r.values.size());
  std::vector<std::size_t> frame;
  const auto reach = [&](std::size_t i) {
    if (in_frame[i] || r.values[i] != *value) return;
    in_frame[i] = true;
    frame.push_back(i);
  };
  cells.each_outermost([&](std::size_t i, int) { reach(i); });
  for (std::size_t n = 0; n < frame.size(); ++n) cells.each_neighbour(frame[n], reach);
  if (static_cast<double>(frame.size()) > (1 - least_share) * static_cast<double>(r.values.size()))
    return std::nullopt;
  std::vector<float> steps, elsewhere;
  for (std::size_t i : frame)
    cells.each_neighbour(i, [&](std::size_t j) {
      if (!in_frame[j] && std::isfinite(r.values[j])) steps.push_back(std::abs(r.values[j] - *value));
    });
  const std::size_t stride = 1 + r.values.size() / 1000000;  // a million are enough for a median
  for (std::size_t i = 0; i < r.values.size(); i += stride)
    if (!in_frame[i] && i + 1 < r.values.size() && (i + 1) % r.width != 0 && !in_frame[i + 1] &&
        std::isfinite(r.values[i] + r.values[i + 1]) && r.values[i] != r.values[i + 1])
      elsewhere.push_back(std::abs(r.values[i + 1] - r.values[i]));
  if (steps.empty()) return std::nullopt;
  const Frame found{*value, frame.front(), static_cast<long long>(frame.size()), median(steps)};
  const float usual = elsewhere.empty() ? 0 : median(elsewhere);  // numbers are whole in many rasters
  if (found.step < least_step || found.step < least_ratio * usual) return std::nullopt;
  return found;
}

void warn_of_frame(const std::string& path, const Frame& frame, double raw) {
  log_warning(concatenate("raster '", path, "': a frame of ", frame.cells,
                          " cells around its data is exactly ", frame.value, ", with a step of ", frame.step,
                          " to it: cells without data? If so, declare them (in the raster step: nodata: ",
                          raw, ", fill_nodata: true), or project with gdalwarp -dstnodata"));
}

}  // namespace desert_sim
