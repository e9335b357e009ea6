#pragma once
/// Heaps of sand at plants and at the edges of obstacles. Paris et al. 2019, section 6: two point
/// primitives, one windward and a lesser one in the lee, where ripples fade, too.
///
/// A square of a lattice has one plant or stone at a random place, where the density d of plants or obstacles
/// exceeds a random share t of the square; its height B grows as s((d − t)/¼), so that heaps rise and sink
/// with what they lean on:
///
///   b(x) = B [ f(|x − p + 0.6 r e|/r) + `bump_lee` f(|x − p − 0.6 r e|/r) ],   f(q) = (1 − q²)³ for q < 1
///
/// with p the place, r the `bump_radius`, and e the mean wind there over its mean speed (ripples.hpp): where
/// winds of several directions blow, the heaps move under the plant.
///
/// Where plants live (plant_feet.hpp), d is that of obstacles alone, and p the place of the widest plant in
/// the square, of radius R, with B in the share s(R/r) of `bump_height`; an obstacle's heap in the same
/// square counts if it is higher. Plants may stand so close to each other that the sum of their heaps would
/// be steep: the highest of them is the ground, unless the sum of those at obstacles is higher.

#include "kernels/micro_relief/plant_feet.hpp"
#include "kernels/micro_relief/ripples.hpp"

namespace desert_sim::micro_relief {

struct Bump {
  float east, north;     ///< its place in its square, 0 … 1
  float away_x, away_y;  ///< 0.6 r e [m]
  float strength;        ///< B over the largest height, 0 … 1
  bool at_foot;          ///< of a plant that lives
};

struct Bumps {
  Lattice lattice;
  std::uint64_t seed;
  float height, per_radius, away, lee;
  Feet feet;

  /// The lattice on a terrain of these lengths [m].
  static Lattice squares(const MicroReliefParameters& p, double length_x, double length_y, bool periodic_x,
                         bool periodic_y) {
    return {length_x, length_y, pitch * double{p.bump_radius}, periodic_x, periodic_y};
  }
  static constexpr double pitch = 2.5;  ///< side of a square with one plant, over the radius of a bump

  Bumps(const MicroReliefParameters& p, std::uint64_t random_seed, const Lattice& squares)
      : lattice(squares),
        seed(random_seed),
        height(p.bumps ? p.bump_height : 0.0f),
        per_radius(1.0f / p.bump_radius),
        away(0.6f * p.bump_radius),
        lee(p.bump_lee) {}

  DESERT_HD Bump bump(const Cells& cells, const Ripples& ripples, int i, int j) const {
    Bump b = random_bump(cells, i, j);
    if (feet.live) {
      const Foot foot(feet.at(lattice, i, j));
      const float strength = smooth_step(foot.radius * per_radius);
      if (strength > b.strength) b = {foot.east, foot.north, 0.0f, 0.0f, strength, true};
    }
    if (!(b.strength > 0.0f)) return b;
    const Ripples::LocalWind wind = ripples.wind_at(cells, corners(cells, b, i, j));
    const float per = away / maximum(wind.speed, 0.1f);
    b.away_x = wind.x * per;
    b.away_y = wind.y * per;
    return b;
  }

  struct Heap {
    float height;     ///< [m]
    float sheltered;  ///< 0 in the open … 1 in the lee of a plant
  };
  /// `bump_of(i, j)` gives the bump of a square next to the place's.
  template <class BumpOf>
  DESERT_HD Heap heap(const Lattice::Square& at, const BumpOf& bump_of) const {
    Heap sum{0.0f, 0.0f};
    float at_feet = 0.0f;
    for (int dj = -1; dj <= 1; ++dj)
      for (int di = -1; di <= 1; ++di) {
        const Bump b = bump_of(at.i + di, at.j + dj);
        if (!(b.strength > 0.0f)) continue;
        const float x = (at.east - static_cast<float>(di) - b.east) * lattice.pitch_x,
                    y = (at.north - static_cast<float>(dj) - b.north) * lattice.pitch_y;
        const float behind = point(x - b.away_x, y - b.away_y);
        const float rise = height * b.strength * (point(x + b.away_x, y + b.away_y) + lee * behind);
        if (b.at_foot)
          at_feet = maximum(at_feet, rise);
        else
          sum.height += rise;
        sum.sheltered = maximum(sum.sheltered, b.strength * behind);
      }
    sum.height = maximum(sum.height, at_feet);
    return sum;
  }

 private:
  DESERT_HD Cells::Corners corners(const Cells& cells, const Bump& b, int i, int j) const {
    return cells.corners((i + double{b.east}) * lattice.pitch_x, (j + double{b.north}) * lattice.pitch_y);
  }
  /// At a random place, by densities; without wind.
  DESERT_HD Bump random_bump(const Cells& cells, int i, int j) const {
    const RandomWords words = random_words(seed, Purpose::sand_bumps, static_cast<std::uint32_t>(i),
                                           static_cast<std::uint32_t>(j), 0);
    constexpr float unit = 1.0f / 16777216.0f;
    const auto share = [&](int n) { return static_cast<float>(words.word[n] >> 8) * unit; };
    Bump b{0.25f + 0.5f * share(0), 0.25f + 0.5f * share(1), 0.0f, 0.0f, 0.0f, false};
    const Cells::Corners at = corners(cells, b, i, j);
    const float stones = cells.value(cells.stones, at);
    const float density = feet.live ? stones : maximum(cells.value(cells.growth, at), stones);
    b.strength = smooth_step((density - 0.75f * share(2)) * 4.0f) * (0.5f + 0.5f * share(3));
    return b;
  }
  DESERT_HD float point(float x, float y) const {
    const float rest = 1.0f - (x * x + y * y) * (per_radius * per_radius);
    return rest > 0.0f ? rest * rest * rest : 0.0f;
  }
};

}  // namespace desert_sim::micro_relief
