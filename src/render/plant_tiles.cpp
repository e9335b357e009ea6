#include "src/render/plant_tiles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "src/render/drawable.hpp"
#include "src/render/plant_shapes.hpp"

namespace desert_sim::render {

namespace {

constexpr int smallest_size = -6, largest_size = 6;  // powers of two: radii of a size differ by a factor of 2
constexpr std::size_t sizes = largest_size - smallest_size + 1;
constexpr double most_columns = 128;  // of tiles, and rows, of one size
constexpr double usual_plants = 128;  // in a tile
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

std::size_t size_of(float radius) {
  return static_cast<std::size_t>(std::clamp(std::ilogb(radius), smallest_size, largest_size) -
                                  smallest_size);
}

/// The square tiles of the plants of one size.
struct TileGrid {
  std::uint64_t plants = 0;
  double west = HUGE_VAL, south = HUGE_VAL, east = -HUGE_VAL, north = -HUGE_VAL;  // of the feet [m]
  double side = 1;
  std::uint32_t first = 0, columns = 0, rows = 0;

  void include(double x, double y) {
    ++plants;
    west = std::min(west, x);
    east = std::max(east, x);
    south = std::min(south, y);
    north = std::max(north, y);
  }
  /// Chooses the tiles; their numbers begin with `number`. Returns the number after them.
  std::uint32_t lay_out(std::uint32_t number) {
    first = number;
    if (plants == 0) return number;
    const double width = east - west, height = north - south, longest = std::max(width, height);
    const double share = usual_plants / static_cast<double>(plants);  // that a tile has: on a plane, in a row
    side = std::max({std::sqrt(share * width * height), share * longest, longest / most_columns, 1e-3});
    columns = static_cast<std::uint32_t>(width / side) + 1;
    rows = static_cast<std::uint32_t>(height / side) + 1;
    return number + columns * rows;
  }
  std::uint32_t tile_at(double x, double y) const {
    return first + static_cast<std::uint32_t>((y - south) / side) * columns +
           static_cast<std::uint32_t>((x - west) / side);
  }
};

bool is_drawable_plant(const PlantColumns& c, std::size_t n, const std::vector<PlantKind>& kinds) {
  return c.kind[n] < kinds.size() && is_drawable(static_cast<double>(c.x[n])) &&
         is_drawable(static_cast<double>(c.y[n])) && is_drawable(static_cast<double>(c.foot[n])) &&
         is_drawable(static_cast<double>(c.radius[n])) && c.radius[n] > 0 &&
         is_drawable(kinds[c.kind[n]].stem);
}

double height_of(const TilePlant& plant, const std::vector<PlantKind>& kinds) {
  Plant shape;
  shape.radius = static_cast<double>(plant.radius);
  shape.stem = kinds[plant.kind].stem;
  shape.health = plant.health / 255.0;
  return shape.height();
}

}  // namespace

PlantTiles::PlantTiles(const PlantColumns& c, std::vector<PlantKind> kinds) : kinds_(std::move(kinds)) {
  std::array<TileGrid, sizes> grids;
  std::vector<bool> drawn(c.count);
  for (std::size_t n = 0; n < c.count; ++n) {
    drawn[n] = is_drawable_plant(c, n, kinds_);
    if (drawn[n])
      grids[size_of(c.radius[n])].include(static_cast<double>(c.x[n]), static_cast<double>(c.y[n]));
  }
  std::uint32_t count = 0;
  for (TileGrid& grid : grids) count = grid.lay_out(count);

  // A counting sort: the plants of each tile, then where each tile ends.
  std::vector<std::uint32_t> tile_of(c.count, none), next(count + 1, 0);
  for (std::size_t n = 0; n < c.count; ++n) {
    if (!drawn[n]) continue;
    tile_of[n] =
        grids[size_of(c.radius[n])].tile_at(static_cast<double>(c.x[n]), static_cast<double>(c.y[n]));
    ++next[tile_of[n] + 1];
  }
  for (std::uint32_t tile = 0; tile < count; ++tile) next[tile + 1] += next[tile];
  plants_.resize(next[count]);
  for (std::size_t n = 0; n < c.count; ++n)
    if (drawn[n])
      plants_[next[tile_of[n]]++] = {c.x[n], c.y[n], c.foot[n], c.radius[n], c.kind[n], c.health[n]};
  std::uint32_t begin = 0;
  for (std::uint32_t tile = 0; tile < count; ++tile) {
    const std::uint32_t end = next[tile];
    std::stable_sort(plants_.begin() + begin, plants_.begin() + end,
                     [](const TilePlant& a, const TilePlant& b) { return a.radius > b.radius; });
    for (; begin < end; begin += std::min(largest_tile, end - begin))
      add_tile(begin, std::min(largest_tile, end - begin));
  }
}

void PlantTiles::add_tile(std::uint32_t first, std::uint32_t count) {
  PlantTile tile{first, count, plants_[first].radius, {}, 0, 0};
  for (std::uint32_t n = first; n < first + count; ++n) {
    const TilePlant& plant = plants_[n];
    tile.feet.extend(Eigen::Vector3f(plant.x, plant.y, plant.foot).cast<double>());
    const double height = height_of(plant, kinds_);
    tile.above = std::max(tile.above, height);
    tile.below = std::max(tile.below, -height);
  }
  tiles_.push_back(tile);
}

Box PlantTiles::box(const PlantTile& tile, double exaggeration) const {
  const auto width = static_cast<double>(tile.widest);
  Box box = tile.feet;
  box.min().z() *= exaggeration;
  box.max().z() *= exaggeration;
  box.min() -= Point(width, width, tile.below);
  box.max() += Point(width, width, tile.above);
  return box;
}

Mesh PlantTiles::mesh(const PlantTile& tile, bool detailed, double exaggeration) const {
  Mesh mesh;
  mesh.vertices.reserve(tile.count * indices_of_plant(detailed));
  mesh.indices.reserve(tile.count * indices_of_plant(detailed));
  for (std::uint32_t n = tile.first; n < tile.first + tile.count; ++n) {
    const TilePlant& plant = plants_[n];
    const PlantKind& kind = kinds_[plant.kind];
    add_plant({static_cast<double>(plant.x), static_cast<double>(plant.y),
               exaggeration * static_cast<double>(plant.foot), static_cast<double>(plant.radius), kind.stem,
               plant.health / 255.0},
              detailed, kind.colour, mesh);
  }
  mesh.surface_indices = mesh.indices.size();
  return mesh;
}

}  // namespace desert_sim::render
