#include "src/simulation/views/micro_relief.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/backend/exec.hpp"
#include "kernels/micro_relief/window.hpp"
#include "kernels/sand/saltation_inputs.hpp"
#include "src/core/error.hpp"
#include "src/terrain/bilinear.hpp"

namespace desert_sim {

using micro_relief::Bumps;
using micro_relief::Cells;
using micro_relief::Lattice;
using micro_relief::Relief;
using micro_relief::Ripples;
using micro_relief::SquareTable;

namespace {

constexpr float drowned = 0.002f;  ///< depth of water under which nothing is left of ripples [m]

Relief relief_of(const MicroReliefSettings& s, const Cells& cells, double cell_size) {
  const Lattice patches(cells.x.count * cell_size, cells.y.count * cell_size,
                        double{s.parameters.crest_length}, cells.x.periodic, cells.y.periodic);
  return {cells, Ripples(s.parameters, s.wind, s.seed, patches),
          Bumps(s.parameters, s.seed, s.bump_squares(cells.x.count, cell_size, cells.x.periodic))};
}

}  // namespace

const std::vector<Layer>& MicroRelief::layers() {
  static const std::vector<Layer> all{Layer::elevation,  Layer::sand,       Layer::soil,   Layer::water,
                                      Layer::moisture,   Layer::obstacle,   Layer::wind_x, Layer::wind_y,
                                      Layer::vegetation, Layer::wind_shadow};
  return all;
}

int MicroRelief::margin(const MicroReliefParameters& p, double cell_size) {
  // Things reach 1¼ sides of a square, which may be a sixth longer than asked for. They take values of the
  // cells around their place, and the slope of a cell is that between its neighbours.
  const double pitch = std::max(double{p.crest_length}, Bumps::pitch * double{p.bump_radius});
  return static_cast<int>(std::ceil(1.5 * pitch / cell_size)) + 3;
}

RowBand MicroRelief::band(const MicroReliefWindow& w, const Snapshot& grid) {
  const int beyond = margin(grid.micro_relief.parameters, grid.cell_size);
  const auto row = [&](double y) {
    const double rows = std::floor((y - grid.micro_relief.origin_y) / grid.cell_size);
    return static_cast<int>(std::clamp(rows, -1e9, 1e9));
  };
  const int first = row(w.y0) - beyond, last = row(w.y0 + w.rows * w.resolution) + beyond;
  return {first, last - first + 1};
}

MicroRelief::MicroRelief(const Snapshot& s)
    : settings_(s.micro_relief),
      cell_size_(s.cell_size),
      origin_x_(s.origin_x),
      origin_y_(s.micro_relief.origin_y),
      width_(s.width),
      height_(s.micro_relief.grid_height),
      periodic_x_(s.periodic_x),
      periodic_y_(s.micro_relief.periodic_y),
      first_row_(wrap(s.micro_relief.first_row, s.micro_relief.grid_height)),
      rows_(s.height),
      relief_(relief_of(s.micro_relief,
                        {{width_, 1 / s.cell_size, periodic_x_}, {height_, 1 / s.cell_size, periodic_y_}},
                        s.cell_size)) {
  take_feet(s);
  fill_cells(s);
  Cells& c = relief_.cells;
  c.first_row = first_row_;
  c.rows = rows_;
  c.sand = sand_.data();
  c.mobile = mobile_.data();
  c.level = level_.data();
  c.growth = growth_.data();
  c.stones = stones_.data();
  c.turn_x = turn_x_.data();
  c.turn_y = turn_y_.data();
}

void MicroRelief::take_feet(const Snapshot& s) {
  if (!settings_.needs_feet()) return;
  if (!s.feet) throw ConfigError("micro_relief of the surface: the snapshot lacks the feet of plants");
  feet_ = s.feet;
  relief_.bumps.feet = {feet_->widest.data(), true, relief_.bumps.lattice.x.count, feet_->first_row,
                        feet_->rows};
}

void MicroRelief::fill_cells(const Snapshot& s) {
  if (!s.find(Layer::elevation))
    throw ConfigError("micro_relief of the surface: the snapshot lacks the layer elevation");
  elevation_ = *s.find(Layer::elevation);
  const std::size_t cells = elevation_.size();
  const std::vector<float> nowhere(cells, 0.0f);
  const auto layer = [&](Layer which) -> const std::vector<float>& {
    const std::vector<float>* const values = s.find(which);
    return values ? *values : nowhere;
  };
  const std::vector<float>&soil = layer(Layer::soil), &water = layer(Layer::water),
        &moisture = layer(Layer::moisture), &shadow = layer(Layer::wind_shadow),
        &wind_x = layer(Layer::wind_x), &wind_y = layer(Layer::wind_y);
  sand_ = layer(Layer::sand);
  growth_ = layer(Layer::vegetation);
  stones_ = layer(Layer::obstacle);
  for (std::vector<float>* const values : {&mobile_, &level_, &turn_x_, &turn_y_})
    values->assign(cells, 0.0f);
  const wind::Vector above = s.wind_above;
  const float square = above.x * above.x + above.y * above.y;
  const auto is_zero = [](const std::vector<float>& values) {
    return std::all_of(values.begin(), values.end(), [](float v) { return v == 0; });
  };
  const bool bare = relief_.bumps.feet.live ? std::all_of(feet_->widest.begin(), feet_->widest.end(),
                                                          [](auto n) { return n == 0; })
                                            : is_zero(growth_);
  if (bare && is_zero(stones_)) relief_.bumps.height = 0;  // it saves looking for them
  // Some models move sand without a layer of the wind.
  const bool wind_is_known = square > 1e-6f && !(is_zero(wind_x) && is_zero(wind_y));
  const float steep = settings_.repose_tangent;
  const saltation::Dryness dryness(settings_.moisture_cutoff);
  for (int y = 0; y < rows_; ++y)
    for (int x = 0; x < width_; ++x) {
      const auto at = [&](int i, int j) {
        const int column = periodic_x_ ? wrap(i, width_) : clamp_index(i, width_),
                  row = s.periodic_y ? wrap(j, rows_) : clamp_index(j, rows_);
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(column);
      };
      const std::size_t i = at(x, y);
      turn_x_[i] = wind_is_known ? (wind_x[i] * above.x + wind_y[i] * above.y) / square : 1.0f;
      turn_y_[i] = wind_is_known ? (wind_y[i] * above.x - wind_x[i] * above.y) / square : 0.0f;
      const float two_cells = static_cast<float>(2 * cell_size_);
      const float slope = hypotenuse(elevation_[at(x + 1, y)] - elevation_[at(x - 1, y)],
                                     elevation_[at(x, y + 1)] - elevation_[at(x, y - 1)]) /
                          two_cells;
      if (std::isnan(slope) || std::isnan(elevation_[i])) continue;
      level_[i] = 1.0f - micro_relief::smooth_step((slope / steep - 0.75f) * 4.0f);
      const float capacity =
          settings_.moisture_capacity *
          std::clamp(soil[i] + sand_[i], repose::least_moist_depth, settings_.moisture_depth);
      mobile_[i] = (1.0f - shadow[i]) * (1.0f - std::clamp(stones_[i], 0.0f, 1.0f)) *
                   (1.0f - micro_relief::smooth_step(water[i] / drowned)) * dryness(moisture[i] / capacity);
    }
}

bool MicroRelief::contains(double x, double y) const {
  const double east = x / cell_size_, north = y / cell_size_;
  return (periodic_x_ || (east >= 0 && east <= width_)) && (periodic_y_ || (north >= 0 && north <= height_));
}

double MicroRelief::surface(double x, double y) const {
  return bilinear(bilinear_axis(x / cell_size_, width_, periodic_x_),
                  bilinear_axis(y / cell_size_, height_, periodic_y_), [this](int i, int j) {
                    const int row = j - first_row_, around = row < 0 && periodic_y_ ? row + height_ : row;
                    return elevation_[static_cast<std::size_t>(clamp_index(around, rows_)) *
                                          static_cast<std::size_t>(width_) +
                                      static_cast<std::size_t>(i)];
                  });
}

double MicroRelief::offset(double x, double y) const {
  const double east = x - origin_x_, north = y - origin_y_;
  return contains(east, north) ? relief_.offset(east, north) : 0;
}

std::vector<float> MicroRelief::elevations(const MicroReliefWindow& w) const {
  const micro_relief::Points points{w.x0 + 0.5 * w.resolution - origin_x_,
                                    w.y0 + 0.5 * w.resolution - origin_y_, w.resolution, w.columns, w.rows};
  std::vector<micro_relief::RipplePatch> patches(SquareTable(relief_.ripples.lattice, points).size());
  std::vector<micro_relief::Bump> bumps(SquareTable(relief_.bumps.lattice, points).size());
  std::vector<float> heights(w.points());
  CpuExec exec(1);  // beside the simulation's threads
  micro_relief::offsets(exec, relief_, points, patches.data(), bumps.data(), heights.data());
  float* height = heights.data();
  for (int row = 0; row < w.rows; ++row)
    for (int column = 0; column < w.columns; ++column, ++height) {
      const double x = points.x(column), y = points.y(row);
      *height = contains(x, y) ? static_cast<float>(surface(x, y) + double{*height})
                               : std::numeric_limits<float>::quiet_NaN();
    }
  return heights;
}

}  // namespace desert_sim
