#include "src/simulation/editing/plant_edit.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "kernels/field/random.hpp"
#include "kernels/plants/lookup.hpp"
#include "src/core/did_you_mean.hpp"
#include "src/core/joined.hpp"
#include "src/scenario/range_checks.hpp"
#include "src/simulation/commands/edit_checks.hpp"

namespace desert_sim {

namespace {

using plants::Column;

/// −1: all of them.
int species_index(const command::EditPlants& edit, const Scenario& s) {
  for (std::size_t n = 0; n < s.species.size(); ++n)
    if (s.species[n].name == edit.species) return static_cast<int>(n);
  return -1;
}

/// The region in metres from the grid's corner.
class Region {
 public:
  Region(const command::EditPlants& edit, const Scenario& s)
      : lookup_(s.make_grid(), s.get<VegetationParameters>().largest_plant) {
    const bool circle = edit.shape == BrushShape::circle;
    const wind::Vector axis = circle ? wind::Vector{1, 0} : unit_vector(edit.angle_deg);
    double x = edit.x, y = edit.y;
    if (!edit.points.empty()) {
      const auto [west, east] = std::minmax_element(edit.points.begin(), edit.points.end(),
                                                    [](const auto& p, const auto& q) { return p.x < q.x; });
      const auto [south, north] = std::minmax_element(edit.points.begin(), edit.points.end(),
                                                      [](const auto& p, const auto& q) { return p.y < q.y; });
      x = 0.5 * (west->x + east->x), y = 0.5 * (south->y + north->y);
      for (const command::Point& p : edit.points)
        vertices_.push_back({static_cast<float>(p.x - x), static_cast<float>(p.y - y)});
    }
    x_ = lookup_.wrap_onto_grid_x(x - s.grid.origin_x);
    y_ = lookup_.wrap_onto_grid_y(y - s.grid.origin_y);
    shape_ = {edit.shape,
              static_cast<float>(edit.radius),
              static_cast<float>(circle ? edit.radius : edit.radius_y),
              axis.x,
              axis.y,
              0.0f,
              0.0f,
              vertices_.data(),
              static_cast<int>(vertices_.size()),
              {},
              {}};
    set_reach(edit);
  }
  bool covers(float x, float y) const {
    return shape_.covers({lookup_.difference_x(x, x_), lookup_.difference_y(y, y_)}, 0.0f);
  }
  /// Whether a place of the cell can lie in the rectangle around the region; `reach`: half the cell's side.
  bool may_reach(float x, float y, float reach) const {
    return std::abs(lookup_.difference_x(x, x_)) <= half_x_ + reach &&
           std::abs(lookup_.difference_y(y, y_)) <= half_y_ + reach;
  }
  /// Most places that may be drawn for it.
  double most_places() const {
    return shape_.count > 2 ? std::min(max_drawn_places, max_drawn_edges / shape_.count) : max_drawn_places;
  }

 private:
  /// Half the sides of the rectangle, with some slack for rounding.
  void set_reach(const command::EditPlants& edit) {
    double x = shape_.a, y = shape_.a;
    if (edit.shape == BrushShape::ellipse || edit.shape == BrushShape::rectangle) {
      const double along = std::abs(shape_.cos), across = std::abs(shape_.sin);
      x = shape_.a * along + shape_.b * across;
      y = shape_.a * across + shape_.b * along;
    } else if (!vertices_.empty()) {
      const bool capsule = edit.shape == BrushShape::capsule;
      x = y = capsule ? shape_.a : 0.0;
      double widest = 0, highest = 0;
      for (const brush::Point& p : vertices_) {
        widest = std::max(widest, std::abs(static_cast<double>(p.x)));
        highest = std::max(highest, std::abs(static_cast<double>(p.y)));
      }
      x += widest, y += highest;
    }
    constexpr double rounding = 1e-5;
    half_x_ = static_cast<float>(x * (1 + rounding) + rounding * lookup_.width);
    half_y_ = static_cast<float>(y * (1 + rounding) + rounding * lookup_.height);
  }

  plants::Lookup lookup_;
  float x_ = 0, y_ = 0;
  float half_x_ = 0, half_y_ = 0;
  std::vector<brush::Point> vertices_;
  brush::Shape shape_;
};

class Edit {
 public:
  Edit(const command::EditPlants& edit, const Scenario& scenario, const Terrain& terrain, std::uint64_t step,
       int most)
      : edit_(edit),
        s_(scenario),
        grid_(terrain.grid()),
        step_(step),
        max_plants_(most),
        region_(edit, scenario) {}

  Population::Edit clear(const std::vector<std::uint32_t>& words) {
    const std::size_t count = words.size() / plants::column_count;
    const int kind = species_index(edit_, s_);
    const auto at = [&](Column c, std::size_t n) { return words[static_cast<std::size_t>(c) * count + n]; };
    for (std::size_t n = 0; n < count; ++n) {
      const bool selected = kind < 0 || static_cast<int>(at(Column::species, n)) == kind;
      if (selected && region_.covers(float_from_bits(at(Column::x, n)), float_from_bits(at(Column::y, n))))
        result_.removed.push_back(static_cast<std::uint32_t>(n));
    }
    return std::move(result_);
  }

  Population::Edit plant(std::size_t count, const Terrain& terrain) {
    room_ = max_plants_ - static_cast<std::ptrdiff_t>(count);
    const std::vector<int> cells = cells_to_plant(terrain);
    const double expected = static_cast<double>(cells.size()) * expected_per_cell(),
                 most = region_.most_places();
    if (expected > most) {
      std::ostringstream text;
      text << "edit_plants: density: " << edit_.density << " 1/m^2 would draw about " << expected
           << " places in the rectangle around the region (allowed: at most " << most << ", which is "
           << edit_.density * most / expected << " 1/m^2 there)";
      throw ConfigError(text.str());
    }
    for (Layer layer : {Layer::bedrock, Layer::soil, Layer::sand})
      if (terrain.has(layer)) ground_.push_back(terrain.raw_words(layer));
    for (const int i : cells) plant_cell(i % grid_.width, i / grid_.width, terrain.scale().quantum());
    return std::move(result_);
  }

 private:
  double expected_per_cell() const { return edit_.density * grid_.cell_size * grid_.cell_size; }

  /// Those near the region that have no obstacle.
  std::vector<int> cells_to_plant(const Terrain& terrain) const {
    const std::vector<float> obstacle = terrain.values(Layer::obstacle);
    const float l = grid_.cell_size;
    std::vector<int> cells;
    for (int y = 0; y < grid_.height; ++y)
      for (int x = 0; x < grid_.width; ++x) {
        const int i = grid_.index(x, y);
        const bool near = region_.may_reach((static_cast<float>(x) + 0.5f) * l,
                                            (static_cast<float>(y) + 0.5f) * l, 0.5f * l);
        if (near && obstacle[static_cast<std::size_t>(i)] == 0) cells.push_back(i);
      }
    return cells;
  }

  void plant_cell(int x, int y, double quantum) {
    const int i = grid_.index(x, y);
    const SpeciesTraits& traits = s_.species[static_cast<std::size_t>(species_index(edit_, s_))].traits;
    Quanta surface = 0;
    for (const auto& layer : ground_) surface += static_cast<Quanta>(layer[static_cast<std::size_t>(i)]);
    const auto bedrock = static_cast<Quanta>(ground_[0][static_cast<std::size_t>(i)]);
    const float loose = static_cast<float>((surface - bedrock) * quantum);
    const float radius = static_cast<float>(edit_.size) * std::min(loose / traits.root, traits.max_radius);
    if (!(radius > 0)) return;
    const double expected = expected_per_cell();
    const auto draw = [&](std::uint32_t which) {
      return random_words(s_.seed + edit_.seed, Purpose::planting, static_cast<std::uint32_t>(i),
                          static_cast<std::uint32_t>(step_), which);
    };
    const auto wanted = static_cast<std::uint32_t>(expected + draw(0).word[0] * 0x1p-32);
    for (std::uint32_t n = 0; n < wanted; ++n) {
      const RandomWords words = draw(n + 1);
      const auto position_in_cell = [&](int cell, std::uint32_t word) {
        return (static_cast<float>(cell) + static_cast<float>(word >> 8) * (1.0f / 16777216.0f)) *
               grid_.cell_size;
      };
      const float px = position_in_cell(x, words.word[0]), py = position_in_cell(y, words.word[1]);
      if (region_.covers(px, py)) add_plant(px, py, surface, radius);
    }
  }

  void add_plant(float x, float y, Quanta z, float radius) {
    if (static_cast<std::ptrdiff_t>(result_.added.size()) >= room_)
      throw ConfigError("edit_plants: density: there would be more than " + std::to_string(max_plants_) +
                        " plants, which is the capacity (vegetation.max_plants sets it)");
    PlantWords plant{};
    const auto set = [&](Column c, std::uint32_t word) { plant[static_cast<std::size_t>(c)] = word; };
    set(Column::x, bits_of(x));
    set(Column::y, bits_of(y));
    set(Column::z, static_cast<std::uint32_t>(z));
    set(Column::radius, bits_of(radius));
    set(Column::health, bits_of(1.0f));
    set(Column::water, bits_of(0.0f));
    set(Column::age, bits_of(0.0f));
    set(Column::species, static_cast<std::uint32_t>(species_index(edit_, s_)));
    result_.added.push_back(plant);
  }

  const command::EditPlants& edit_;
  const Scenario& s_;
  Grid grid_;
  std::uint64_t step_;
  int max_plants_;
  Region region_;
  std::vector<std::vector<std::uint32_t>> ground_;  ///< bedrock first
  std::ptrdiff_t room_ = 0;                         ///< for more plants
  Population::Edit result_;
};

}  // namespace

void check_plant_edit(const command::EditPlants& edit, const Scenario& s) {
  if (!s.get<VegetationParameters>().enabled)
    throw ConfigError("edit_plants: this scenario has no plants (vegetation.enabled)");
  check_ranges(static_cast<const command::EditPlantsParameters&>(edit), "edit_plants");
  ValidationErrors errors("edit_plants");
  if (edit.shape == BrushShape::patch)
    errors.add("shape", "patch is not one of: circle, ellipse, rectangle, polygon, capsule");
  else
    check_points(edit.shape, edit.points, errors);
  const bool all = edit.operation == PlantEdit::clear && edit.species.empty();
  if (!all && species_index(edit, s) < 0) {
    const std::string known = joined(s.species, [](const Species& species) { return species.name; });
    errors.add("species", not_one_of(edit.species, known));
  }
  errors.throw_if_any();
}

Population::Edit plant_edit(const command::EditPlants& edit, const Scenario& scenario, const Terrain& terrain,
                            std::uint64_t step, int most, const std::vector<std::uint32_t>& words) {
  Edit work(edit, scenario, terrain, step, most);
  return edit.operation == PlantEdit::clear ? work.clear(words)
                                            : work.plant(words.size() / plants::column_count, terrain);
}

}  // namespace desert_sim
