#pragma once
/// Plants in millions, sorted by size and place into tiles that are drawn one by one. All plants of a tile
/// are of about the same size, so that a camera sees all of them large enough to draw, or none.

#include <cstdint>
#include <vector>

#include "src/render/mesh.hpp"

namespace desert_sim::render {

/// What the plants of a species have in common.
struct PlantKind {
  double stem = 1;  ///< ratio of the stem's height to the radius
  Colour colour;    ///< of the crown
};

/// Plants as messages have them: an array of `count` values for each property. Nothing is known of the
/// values.
struct PlantColumns {
  std::size_t count = 0;
  const float *x = nullptr, *y = nullptr, *foot = nullptr, *radius = nullptr;  ///< [m]
  const std::uint8_t *kind = nullptr, *health = nullptr;                       ///< health: 255 is full
};

struct TilePlant {
  float x, y, foot, radius;  ///< [m]
  std::uint8_t kind, health;
};

struct PlantTile {
  std::uint32_t first = 0, count = 0;  ///< its plants, the widest first
  float widest = 0;                    ///< largest radius [m]
  Box feet;                            ///< around the points where stems and roots meet
  double above = 0, below = 0;         ///< how far plants reach beyond their feet [m]
};

class PlantTiles {
 public:
  static constexpr std::uint32_t largest_tile = 256;  ///< plants: what is built in one go

  PlantTiles() = default;
  /// Leaves out plants without a width or a kind, and those that no desert has.
  PlantTiles(const PlantColumns& columns, std::vector<PlantKind> kinds);

  const std::vector<PlantTile>& tiles() const { return tiles_; }
  const std::vector<TilePlant>& plants() const { return plants_; }
  const std::vector<PlantKind>& kinds() const { return kinds_; }

  /// The place of a tile, whose feet are at `exaggeration` times their height.
  Box box(const PlantTile& tile, double exaggeration) const;
  /// All plants of a tile, the widest first, each with indices_of_plant(detailed) indices.
  Mesh mesh(const PlantTile& tile, bool detailed, double exaggeration) const;

 private:
  void add_tile(std::uint32_t first, std::uint32_t count);

  std::vector<PlantKind> kinds_;
  std::vector<TilePlant> plants_;  ///< tile by tile
  std::vector<PlantTile> tiles_;
};

}  // namespace desert_sim::render
