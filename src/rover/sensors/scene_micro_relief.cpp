#include "src/rover/sensors/scene_micro_relief.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "src/simulation/views/micro_relief.hpp"

namespace desert_sim {

using micro_relief::Cells;

namespace {

/// In the order of SceneMicroRelief::layers_.
constexpr std::array<const float * Cells::*, 7> layers_of_cells{
    &Cells::sand,  &Cells::growth, &Cells::stones, &Cells::mobile,
    &Cells::level, &Cells::turn_x, &Cells::turn_y};

int tiles(int cells, int side) { return (cells + side - 1) / side; }

bool is_bare(const MicroReliefSource& source, const PlantFeet* feet) {
  const bool no_plants = feet ? std::all_of(feet->widest.begin(), feet->widest.end(),
                                            [](micro_relief::FootNumber n) { return n == 0; })
                              : source.is_zero(Layer::vegetation);
  return no_plants && source.is_zero(Layer::obstacle);
}

}  // namespace

SceneMicroRelief::SceneMicroRelief(Exec& exec, std::shared_ptr<const MicroReliefSource> source)
    : exec_(exec),
      source_(std::move(source)),
      relief_(relief_without_cells(source_->grid())),
      columns_(tiles(source_->grid().width, side)),
      rows_(tiles(source_->grid().height, side)) {
  const std::size_t cells =
      static_cast<std::size_t>(source_->grid().width) * static_cast<std::size_t>(source_->grid().height);
  for (std::size_t n = 0; n < layers_of_cells.size(); ++n) {
    layers_.emplace_back(exec_, cells);
    layers_.back().set_zero();  // what lies too far away for a weight above 0 has to be a number
  }
  set(source_);
}

void SceneMicroRelief::set(std::shared_ptr<const MicroReliefSource> source) {
  source_ = std::move(source);
  relief_ = relief_without_cells(source_->grid());
  relief_.cells.rows = source_->grid().height;
  for (std::size_t n = 0; n < layers_of_cells.size(); ++n)
    relief_.cells.*layers_of_cells[n] = layers_[n].data();
  take_feet();
  if (is_bare(*source_, relief_.bumps.feet.live ? feet_.get() : nullptr))
    relief_.bumps.height = 0;  // it saves looking for heaps
  law_ = std::make_unique<const MicroReliefCells>(
      source_->grid(), !(source_->is_zero(Layer::wind_x) && source_->is_zero(Layer::wind_y)));
  computed_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0);
  computed_cells_ = 0;
}

void SceneMicroRelief::take_feet() {
  if (!source_->grid().micro_relief.needs_feet()) return;
  const std::shared_ptr<const PlantFeet> feet = source_->feet();
  if (feet_ != feet) {
    if (feet_numbers_.size() != feet->widest.size()) feet_numbers_ = {exec_, feet->widest.size()};
    feet_numbers_.upload(feet->widest);
    feet_ = feet;
  }
  relief_.bumps.feet = {feet_numbers_.data(), true, relief_.bumps.lattice.x.count, feet->first_row,
                        feet->rows};
}

/// Which columns or rows of tiles have cells on which heights depend that are on the terrain and up to
/// `reach` from a place, both in cells.
std::vector<char> SceneMicroRelief::tiles_along(double place, double reach,
                                                const micro_relief::Axis& axis) const {
  const int beyond = MicroRelief::margin(source_->grid().micro_relief.parameters, source_->grid().cell_size);
  const auto cell = [&](double at) {
    return static_cast<int>(std::floor(std::clamp(at, 0.0, static_cast<double>(axis.count))));
  };
  const int first = cell(place - reach) - beyond, last = cell(place + reach) + beyond;
  std::vector<char> wanted(static_cast<std::size_t>(tiles(axis.count, side)), 0);
  for (int n = first; n <= last; ++n)
    wanted[static_cast<std::size_t>((axis.periodic ? wrap(n, axis.count) : clamp_index(n, axis.count)) /
                                    side)] = 1;
  return wanted;
}

ray_march::RippledGround SceneMicroRelief::within(double x, double y, double reach, std::size_t beams) {
  const double east = x - source_->grid().origin_x, north = y - source_->grid().origin_y;
  compute_cells(east, north, reach);
  micro_relief::KnownSquares known;
  known.patch_box = squares_around(relief_.ripples.lattice, east, north, reach, beams);
  if (relief_.bumps.height > 0)
    known.bump_box = squares_around(relief_.bumps.lattice, east, north, reach, beams);
  if (patches_.size() < known.patch_box.size()) patches_ = {exec_, known.patch_box.size()};
  if (bumps_.size() < known.bump_box.size()) bumps_ = {exec_, known.bump_box.size()};
  known.patches = patches_.data();
  known.bumps = bumps_.data();
  with_backend(exec_, [&](auto& exec) {
    fill_squares(exec, relief_, known.patch_box, patches_.data(), known.bump_box, bumps_.data());
  });
  return {relief_, known, source_->grid().cell_size};
}

/// Those around a place in metres from the terrain's south-west corner, of which beams meet most.
micro_relief::SquareBox SceneMicroRelief::squares_around(const micro_relief::Lattice& lattice, double x,
                                                         double y, double reach, std::size_t beams) {
  // Twice as many as beams. Farther ones are met so seldom that it is cheaper to compute them then.
  const double most = std::sqrt(0.5 * static_cast<double>(beams));
  const auto along = [&](const micro_relief::Axis& axis, double place, int& first, int& count) {
    const double squares = std::min(reach * axis.parts_per_metre, most),
                 centre = place * axis.parts_per_metre;
    const auto square = [&axis](double at) {
      return static_cast<int>(std::floor(std::clamp(at, 0.0, static_cast<double>(axis.count))));
    };
    first = square(centre - squares) - 1;
    count = square(centre + squares) + 2 - first;
  };
  micro_relief::SquareBox box;
  along(lattice.x, x, box.first_column, box.columns);
  along(lattice.y, y, box.first_row, box.rows);
  return box;
}

void SceneMicroRelief::compute_cells(double x, double y, double reach) {
  const Snapshot& grid = source_->grid();
  const double cells = reach / grid.cell_size;
  const std::vector<char> columns = tiles_along(x / grid.cell_size, cells, relief_.cells.x),
                          rows = tiles_along(y / grid.cell_size, cells, relief_.cells.y);
  for (int row = 0; row < rows_; ++row) {
    if (!rows[static_cast<std::size_t>(row)]) continue;
    char* const computed = computed_.data() + std::ptrdiff_t{row} * columns_;
    const auto missing = [&](int column) {
      return columns[static_cast<std::size_t>(column)] && !computed[column];
    };
    for (int column = 0; column < columns_; ++column) {
      const int first = column;
      for (; column < columns_ && missing(column); ++column) computed[column] = 1;
      if (column == first) continue;
      compute({first * side, row * side, std::min(column * side, grid.width) - first * side,
               std::min(side, grid.height - row * side)});
    }
  }
}

void SceneMicroRelief::compute(const Rectangle& r) {
  const std::size_t cells = static_cast<std::size_t>(r.width) * static_cast<std::size_t>(r.height);
  std::array<std::vector<float>, layers_of_cells.size()> values;
  constexpr std::array copied{Layer::sand, Layer::vegetation, Layer::obstacle};
  for (std::size_t n = 0; n < copied.size(); ++n) values[n] = source_->values(copied[n], r);
  for (std::vector<float>& layer : values) layer.resize(cells, 0.0f);
  law_->fill(*source_, r, {values[3].data(), values[4].data(), values[5].data(), values[6].data()});
  for (std::size_t n = 0; n < values.size(); ++n) upload(values[n], r, layers_[n].data());
  computed_cells_ += cells;
}

void SceneMicroRelief::upload(const std::vector<float>& values, const Rectangle& cells, float* layer) {
  const float* from = values.data();
  if (!exec_.shares_memory()) {
    if (staging_.size() < values.size()) staging_ = Buffer<float>(exec_, values.size());
    staging_.upload(values);
    from = staging_.data();
  }
  with_backend(exec_, [&](auto& exec) {
    height_field::write_rectangle(exec, from, cells, height_field::Sane::as_they_are, source_->grid().width,
                                  layer);
  });
}

}  // namespace desert_sim
