#pragma once
/// Individual plants, one column a quantity, on the device.

#include <cstdint>

#include "kernels/backend/buffer.hpp"
#include "kernels/field/quanta.hpp"

namespace desert_sim::plants {

/// Columns, each of four-byte values, in this order.
enum class Column : int { x, y, z, radius, health, water, age, species };
constexpr int column_count = 8;

/// Plain pointers to the columns.
///   x, y     [m] from the grid's south-west corner, in the grid
///   z        [quanta above the datum] where stem and root meet; the ground's surface when it came up
///   radius   [m];  health 0 … 1;  age [s];  species: index into the list
///   water    what it stores [m³ of soaked ground]
struct View {
  float *x = nullptr, *y = nullptr;
  Quanta* z = nullptr;
  float *radius = nullptr, *health = nullptr, *water = nullptr, *age = nullptr;
  std::int32_t* species = nullptr;

  View() = default;
  View(std::uint32_t* words, int capacity) {
    const auto column = [&](Column c) {
      return static_cast<void*>(words + static_cast<std::size_t>(c) * static_cast<std::size_t>(capacity));
    };
    x = static_cast<float*>(column(Column::x));
    y = static_cast<float*>(column(Column::y));
    z = static_cast<Quanta*>(column(Column::z));
    radius = static_cast<float*>(column(Column::radius));
    health = static_cast<float*>(column(Column::health));
    water = static_cast<float*>(column(Column::water));
    age = static_cast<float*>(column(Column::age));
    species = static_cast<std::int32_t*>(column(Column::species));
  }

  /// Copies plant `n` of `from` to place `i`.
  DESERT_HD void take(int i, const View& from, int n) const {
    x[i] = from.x[n];
    y[i] = from.y[n];
    z[i] = from.z[n];
    radius[i] = from.radius[n];
    health[i] = from.health[n];
    water[i] = from.water[n];
    age[i] = from.age[n];
    species[i] = from.species[n];
  }
};

}  // namespace desert_sim::plants
