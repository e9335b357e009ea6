#pragma once
/// The plants on the device as a structure of arrays, one column for each quantity.

#include <cstdint>

#include "kernels/backend/buffer.hpp"
#include "kernels/base/quanta.hpp"

namespace desert_sim::plants {

/// Columns, each of four-byte values, in this order.
enum class Column : int { x, y, z, radius, health, water, age, species };
constexpr int column_count = 8;

/// Plain pointers to the columns.
///
///   x, y      position [m] from the grid's south-west corner, inside the grid
///   z         where stem and root meet [quanta above the datum]; initially the surface of the ground
///   radius    [m]
///   health    0 … 1
///   water     stored water [m³ of saturated ground]
///   age       [s]
///   species   index into the list of species
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
  DESERT_HD void copy_from(int i, const View& from, int n) const {
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
