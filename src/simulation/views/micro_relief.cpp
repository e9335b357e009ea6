#include "src/simulation/views/micro_relief.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/backend/exec.hpp"
#include "kernels/micro_relief/window.hpp"
#include "src/core/error.hpp"
#include "src/terrain/bilinear.hpp"

namespace desert_sim {

using micro_relief::Bumps;
using micro_relief::Cells;
using micro_relief::SquareTable;

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
      relief_(relief_without_cells(s)) {
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
  const auto copy = [&](Layer which) {
    const std::vector<float>* const values = s.find(which);
    return values ? *values : std::vector<float>(cells, 0.0f);
  };
  sand_ = copy(Layer::sand);
  growth_ = copy(Layer::vegetation);
  stones_ = copy(Layer::obstacle);
  for (std::vector<float>* const values : {&mobile_, &level_, &turn_x_, &turn_y_}) values->resize(cells);
  const auto zero = [](float v) { return v == 0; };
  const auto is_zero = [&](Layer layer) {
    const std::vector<float>* const values = s.find(layer);
    return !values || std::all_of(values->begin(), values->end(), zero);
  };
  const bool bare = relief_.bumps.feet.live ? std::all_of(feet_->widest.begin(), feet_->widest.end(),
                                                          [](auto n) { return n == 0; })
                                            : is_zero(Layer::vegetation);
  if (bare && is_zero(Layer::obstacle)) relief_.bumps.height = 0;  // it saves looking for them
  fill_rows(s, MicroReliefCells(s, !(is_zero(Layer::wind_x) && is_zero(Layer::wind_y))));
}

void MicroRelief::fill_rows(const Snapshot& s, const MicroReliefCells& law) {
  const auto begin_of = [this](int y) { return std::ptrdiff_t{y} * width_; };
  // The elevations of a row, and beyond its ends.
  const auto framed = [&](int y) {
    const float* const row =
        elevation_.data() + begin_of(s.periodic_y ? wrap(y, rows_) : clamp_index(y, rows_));
    std::vector<float> values{row[periodic_x_ ? width_ - 1 : 0]};
    values.insert(values.end(), row, row + width_);
    values.push_back(row[periodic_x_ ? 0 : width_ - 1]);
    return values;
  };
  std::vector<float> south = framed(-1), here = framed(0);
  for (int y = 0; y < rows_; ++y) {
    std::vector<float> north = framed(y + 1);
    const std::ptrdiff_t begin = begin_of(y);
    const auto row = [&](Layer layer) {
      const std::vector<float>* const values = s.find(layer);
      return values ? values->data() + begin : nullptr;
    };
    law.fill({here.data() + 1, south.data() + 1, north.data() + 1, row(Layer::sand), row(Layer::soil),
              row(Layer::water), row(Layer::moisture), row(Layer::obstacle), row(Layer::wind_x),
              row(Layer::wind_y), row(Layer::wind_shadow)},
             width_,
             {mobile_.data() + begin, level_.data() + begin, turn_x_.data() + begin, turn_y_.data() + begin});
    south.swap(here);
    here.swap(north);
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
