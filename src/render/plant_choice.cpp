#include "src/render/plant_choice.hpp"

#include <algorithm>

namespace desert_sim::render {

namespace {

/// A tile in detail stays so down to this share of the pixels from which on it becomes so.
constexpr double keeps = 0.8;

struct SeenTile {
  std::size_t tile;
  double pixels, distance;
  bool operator<(const SeenTile& o) const {
    if (pixels != o.pixels) return pixels > o.pixels;
    return distance != o.distance ? distance < o.distance : tile < o.tile;
  }
};

/// The largest `count` tiles that are large enough, in order.
std::vector<SeenTile> largest_tiles(const PlantTiles& plants, const View& view, double exaggeration,
                                    double pixels, std::size_t count) {
  std::vector<SeenTile> seen;
  for (std::size_t n = 0; n < plants.tiles().size(); ++n) {
    const PlantTile& tile = plants.tiles()[n];
    const Box box = plants.box(tile, exaggeration);
    const double radius = static_cast<double>(tile.widest) * view.pixels_per_metre(box);
    if (radius >= pixels && view.sees(box)) seen.push_back({n, radius, view.distance(box)});
  }
  const auto end = seen.begin() + static_cast<std::ptrdiff_t>(std::min(count, seen.size()));
  std::partial_sort(seen.begin(), end, seen.end());
  seen.erase(end, seen.end());
  return seen;
}

}  // namespace

std::vector<ChosenTile> choose_plant_tiles(const PlantTiles& plants, const View& view, double exaggeration,
                                           const PlantLimits& limits,
                                           const std::function<bool(std::size_t tile)>& in_detail) {
  std::vector<ChosenTile> chosen;
  std::size_t left = limits.plants, left_in_detail = (limits.plants + 9) / 10;
  for (const SeenTile& seen : largest_tiles(plants, view, exaggeration, limits.pixels, limits.tiles)) {
    if (left == 0) break;
    const auto count =
        static_cast<std::uint32_t>(std::min<std::size_t>(left, plants.tiles()[seen.tile].count));
    const double wanted = limits.detailed_pixels * (in_detail(seen.tile) ? keeps : 1);
    const bool detailed = seen.pixels >= wanted && count <= left_in_detail;
    if (detailed) left_in_detail -= count;
    left -= count;
    chosen.push_back({seen.tile, count, detailed});
  }
  return chosen;
}

}  // namespace desert_sim::render
