#include "src/simulation/views/micro_relief_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/sand/saltation_inputs.hpp"

namespace desert_sim {

namespace {

constexpr float drowned = 0.002f;  ///< depth of water under which nothing is left of ripples [m]

float value_or_zero_at(const float* layer, int i) { return layer ? layer[i] : 0.0f; }

}  // namespace

micro_relief::Relief relief_without_cells(const Snapshot& grid) {
  using namespace micro_relief;
  const MicroReliefSettings& s = grid.micro_relief;
  Cells cells;
  cells.x = {grid.width, 1 / grid.cell_size, grid.periodic_x};
  cells.y = {s.grid_height, 1 / grid.cell_size, s.periodic_y};
  const Lattice patches(cells.x.count * grid.cell_size, cells.y.count * grid.cell_size,
                        double{s.parameters.crest_length}, cells.x.periodic, cells.y.periodic);
  return {cells, Ripples(s.parameters, s.wind, s.seed, patches),
          Bumps(s.parameters, s.seed, s.bump_squares(cells.x.count, grid.cell_size, cells.x.periodic))};
}

bool MicroReliefSource::is_zero(Layer layer) const {
  const int width = grid().width;
  for (int y = 0; y < grid().height; ++y) {
    const std::vector<float> row = values(layer, {0, y, width, 1});
    if (std::any_of(row.begin(), row.end(), [](float v) { return v != 0; })) return false;
  }
  return true;
}

std::vector<float> MicroReliefSource::elevations_with_frame(const Rectangle& r) const {
  const Snapshot& g = grid();
  const int west = std::max(r.x - 1, 0), east = std::min(r.x + r.width, g.width - 1);
  std::vector<float> framed;
  framed.reserve(static_cast<std::size_t>(r.width + 2) * static_cast<std::size_t>(r.height + 2));
  for (int y = r.y - 1; y <= r.y + r.height; ++y) {
    const int row = g.periodic_y ? wrap(y, g.height) : clamp_index(y, g.height);
    const auto append = [&](int x, int width) {
      const std::vector<float> cells = values(Layer::elevation, {x, row, width, 1});
      framed.insert(framed.end(), cells.begin(), cells.end());
    };
    if (west == r.x) append(g.periodic_x ? g.width - 1 : 0, 1);
    append(west, east - west + 1);
    if (east < r.x + r.width) append(g.periodic_x ? 0 : g.width - 1, 1);
  }
  return framed;
}

MicroReliefCells::MicroReliefCells(const Snapshot& grid, bool wind_is_known)
    : settings_(grid.micro_relief),
      wind_above_(grid.wind_above),
      two_cells_(static_cast<float>(2 * grid.cell_size)),
      wind_square_(wind_above_.x * wind_above_.x + wind_above_.y * wind_above_.y),
      wind_is_known_(wind_is_known && wind_square_ > 1e-6f) {}

void MicroReliefCells::fill_turns(const Row& row, int cells, const Values& to) const {
  const wind::Vector above = wind_above_;
  for (int x = 0; x < cells; ++x) {
    const float u = value_or_zero_at(row.wind_x, x), v = value_or_zero_at(row.wind_y, x);
    to.turn_x[x] = wind_is_known_ ? (u * above.x + v * above.y) / wind_square_ : 1.0f;
    to.turn_y[x] = wind_is_known_ ? (v * above.x - u * above.y) / wind_square_ : 0.0f;
  }
}

void MicroReliefCells::fill(const Row& row, int cells, const Values& to) const {
  fill_turns(row, cells, to);
  const float steep = settings_.repose_tangent;
  const saltation::Dryness dryness(settings_.moisture_cutoff);
  for (int x = 0; x < cells; ++x) {
    const float slope =
        hypotenuse(row.elevation[x + 1] - row.elevation[x - 1], row.north[x] - row.south[x]) / two_cells_;
    to.mobile[x] = to.level[x] = 0.0f;
    if (std::isnan(slope) || std::isnan(row.elevation[x])) continue;
    to.level[x] = 1.0f - micro_relief::smooth_step((slope / steep - 0.75f) * 4.0f);
    const float depth = value_or_zero_at(row.soil, x) + value_or_zero_at(row.sand, x);
    const float capacity =
        settings_.moisture_capacity * std::clamp(depth, repose::least_moist_depth, settings_.moisture_depth);
    to.mobile[x] = (1.0f - value_or_zero_at(row.wind_shadow, x)) *
                   (1.0f - std::clamp(value_or_zero_at(row.obstacle, x), 0.0f, 1.0f)) *
                   (1.0f - micro_relief::smooth_step(value_or_zero_at(row.water, x) / drowned)) *
                   dryness(value_or_zero_at(row.moisture, x) / capacity);
  }
}

void MicroReliefCells::fill(const MicroReliefSource& source, const MicroReliefSource::Rectangle& r,
                            const Values& to) const {
  const std::vector<float> elevation = source.elevations_with_frame(r);
  constexpr std::array layers{Layer::sand,     Layer::soil,   Layer::water,  Layer::moisture,
                              Layer::obstacle, Layer::wind_x, Layer::wind_y, Layer::wind_shadow};
  std::array<std::vector<float>, layers.size()> values;
  std::transform(layers.begin(), layers.end(), values.begin(),
                 [&](Layer layer) { return source.values(layer, r); });
  for (int y = 0; y < r.height; ++y) {
    const std::ptrdiff_t begin = std::ptrdiff_t{y} * r.width, framed = r.width + 2;
    const auto row = [&](std::size_t n) { return values[n].empty() ? nullptr : values[n].data() + begin; };
    const float* const here = elevation.data() + (y + 1) * framed + 1;
    fill({here, here - framed, here + framed, row(0), row(1), row(2), row(3), row(4), row(5), row(6), row(7)},
         r.width, {to.mobile + begin, to.level + begin, to.turn_x + begin, to.turn_y + begin});
  }
}

}  // namespace desert_sim
