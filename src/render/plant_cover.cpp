#include "src/render/plant_cover.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "src/render/plant_shapes.hpp"

namespace desert_sim::render {

namespace {

constexpr int levels = 5;                    // further away, pixels of the last one are taken as they are
constexpr int multiple = 1 << (levels - 1);  // of which width and height are, so that levels halve evenly
constexpr double pixels_per_plant = 64, fewest_pixels = 1 << 16;
constexpr int pixels_per_strip = 1 << 17;  // half a megabyte
/// Crowns of a real desert lie in few layers. Those that come after so many layers over the whole picture
/// cannot be seen.
constexpr double most_layers = 64;

double square(double value) { return value * value; }

/// Light that comes from the ground, and what crowns add to it.
struct Pixel {
  float red = 0, green = 0, blue = 0, bare = 1;
};

/// The mean colour of a crown in the light, so that plants far away are as bright as their shapes near.
Colour colour_in_light(const PlantKind& kind) {
  Plant plant;
  plant.radius = 1;
  plant.stem = kind.stem;
  Mesh mesh;
  add_plant(plant, false, kind.colour, mesh);
  Colour mean;
  for (const Vertex& vertex : mesh.vertices) {
    const float share = 1 / (255 * static_cast<float>(mesh.vertices.size()));
    mean.r += share * static_cast<float>(vertex.colour & 255);
    mean.g += share * static_cast<float>(vertex.colour >> 8 & 255);
    mean.b += share * static_cast<float>(vertex.colour >> 16 & 255);
  }
  return mean;
}

Box box_of_feet(const PlantTiles& plants) {
  Box box;
  for (const PlantTile& tile : plants.tiles()) box.extend(tile.feet);
  return box;
}

/// Chooses the grid. Its corner and its size are multiples, so that it stays as it is while plants come and
/// go.
CoverPicture empty_picture(const PlantTiles& plants) {
  const Box feet = box_of_feet(plants);
  const double most = std::max(pixels_per_plant * static_cast<double>(plants.plants().size()), fewest_pixels);
  CoverPicture picture;
  for (int power = -6;; ++power) {
    picture.pixel = std::ldexp(1, power);
    const double step = multiple * picture.pixel;
    picture.west = step * std::floor(feet.min().x() / step);
    picture.south = step * std::floor(feet.min().y() / step);
    const double columns = std::floor((feet.max().x() - picture.west) / step) + 1,
                 rows = std::floor((feet.max().y() - picture.south) / step) + 1;
    constexpr double most_columns = CoverPicture::most_pixels / multiple;
    if (columns > most_columns || rows > most_columns || columns * rows * multiple * multiple > most)
      continue;
    picture.width = multiple * static_cast<int>(columns);
    picture.height = multiple * static_cast<int>(rows);
    return picture;
  }
}

class Painter {
 public:
  Painter(CoverPicture& picture, const CoverBounds& bounds)
      : picture_(picture),
        west_(first(bounds.west - picture.west, picture.width)),
        south_(first(bounds.south - picture.south, picture.height)),
        east_(end(bounds.east - picture.west, picture.width)),
        north_(end(bounds.north - picture.south, picture.height)),
        pixels_(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height)),
        work_(most_layers * static_cast<double>(pixels_.size())) {}

  /// A disc with soft edges; all of one that is smaller than a pixel in the pixel where it is.
  void paint(const TilePlant& plant, const Colour& colour) {
    const double x = (static_cast<double>(plant.x) - picture_.west) / picture_.pixel,
                 y = (static_cast<double>(plant.y) - picture_.south) / picture_.pixel,
                 radius = static_cast<double>(plant.radius) / picture_.pixel;
    if (radius < 0.5) {
      const int column = static_cast<int>(x), row = static_cast<int>(y);
      if (column >= west_ && column < east_ && row >= south_ && row < north_)
        add(column, row, static_cast<float>(pi * radius * radius), colour);
      return;
    }
    const auto low = [&](double at, int begin) {
      return static_cast<int>(std::max<double>(begin, at - radius - 0.5));
    };
    const auto high = [&](double at, int end) {
      return static_cast<int>(std::min(end - 1.0, at + radius + 0.5));
    };
    const int west = low(x, west_), east = high(x, east_), south = low(y, south_), north = high(y, north_);
    if (west > east || south > north) return;
    work_ -= (east - west + 1.0) * (north - south + 1.0);
    if (work_ < 0) return;
    const auto soft = static_cast<float>(std::sqrt(radius * radius - 1.0 / 12));  // its edges add area
    for (int row = south; row <= north; ++row)
      for (int column = west; column <= east; ++column) {
        const auto away = static_cast<float>(std::sqrt(square(column + 0.5 - x) + square(row + 0.5 - y)));
        const float share = soft + 0.5f - away;
        if (share > 0) add(column, row, std::min(1.0f, share), colour);
      }
  }

  std::vector<PackedColour> pixels() const {
    Pixel all{0, 0, 0, 0};
    for (const Pixel& pixel : pixels_) {
      all.red += pixel.red;
      all.green += pixel.green;
      all.blue += pixel.blue;
      all.bare += 1 - pixel.bare;
    }
    const float covered = std::max(all.bare, 1e-6f);  // none, if no plant stands within the bounds
    const Colour mean{all.red / covered, all.green / covered, all.blue / covered};
    std::vector<PackedColour> packed;
    packed.reserve(pixels_.size());
    for (const Pixel& p : pixels_) {
      const float cover = 1 - p.bare;  // where there is none, filters find the colour of plants, too
      packed.push_back(cover > 0 ? pack({p.red / cover, p.green / cover, p.blue / cover}, cover)
                                 : pack(mean, 0));
    }
    return packed;
  }

 private:
  /// The columns, or rows, that lie as a whole beyond the first bound and before the last one [m].
  int first(double bound, int count) const {
    return static_cast<int>(std::clamp<double>(std::ceil(bound / picture_.pixel), 0, count));
  }
  int end(double bound, int count) const {
    return static_cast<int>(std::clamp<double>(std::floor(bound / picture_.pixel), 0, count));
  }
  void add(int column, int row, float share, const Colour& colour) {
    Pixel& pixel = pixels_[static_cast<std::size_t>(row) * static_cast<std::size_t>(picture_.width) +
                           static_cast<std::size_t>(column)];
    const float rest = 1 - share;
    pixel.red = rest * pixel.red + share * colour.r;
    pixel.green = rest * pixel.green + share * colour.g;
    pixel.blue = rest * pixel.blue + share * colour.b;
    pixel.bare *= rest;
  }

  CoverPicture& picture_;
  const int west_, south_, east_, north_;  ///< pixels that may be painted
  std::vector<Pixel> pixels_;
  double work_;  ///< pixels that may still be looked at
};

/// The mean of four pixels, with colours weighted by alpha.
PackedColour mean_of(const std::array<PackedColour, 4>& four) {
  std::uint32_t alpha = 0;
  for (const PackedColour one : four) alpha += one >> 24;
  PackedColour mean = (alpha + 2) / 4 << 24;
  for (int shift = 0; shift < 24; shift += 8) {
    std::uint32_t sum = 0;
    for (const PackedColour one : four) sum += (one >> shift & 255) * (alpha > 0 ? one >> 24 : 1);
    const std::uint32_t weight = alpha > 0 ? alpha : 4;
    mean |= (sum + weight / 2) / weight << shift;
  }
  return mean;
}

std::vector<PackedColour> halved(const std::vector<PackedColour>& pixels, std::size_t width) {
  std::vector<PackedColour> half;
  half.reserve(pixels.size() / 4);
  for (std::size_t row = 0; row + 1 < pixels.size() / width; row += 2)
    for (std::size_t n = row * width; n + 1 < (row + 1) * width; n += 2)
      half.push_back(mean_of({pixels[n], pixels[n + 1], pixels[n + width], pixels[n + width + 1]}));
  return half;
}

std::uint64_t hash_of(const PackedColour* begin, const PackedColour* end) {  // FNV-1a, by pixels
  std::uint64_t hash = 14695981039346656037u;
  for (; begin != end; ++begin) hash = (hash ^ *begin) * 1099511628211u;
  return hash;
}

void add_strips(CoverPicture& picture, std::size_t level) {
  const int width = picture.width >> level, height = picture.height >> level;
  const int most = std::max(1, pixels_per_strip / width);
  const PackedColour* const pixels = picture.levels[level].data();
  for (int first = 0; first < height; first += most) {
    const int rows = std::min(most, height - first);
    const PackedColour* const begin = pixels + static_cast<std::ptrdiff_t>(first) * width;
    picture.strips.push_back(
        {level, first, rows, hash_of(begin, begin + static_cast<std::ptrdiff_t>(rows) * width)});
  }
}

}  // namespace

CoverPicture plant_cover(const PlantTiles& plants, const CoverBounds& bounds) {
  if (plants.plants().empty()) return {};
  CoverPicture picture = empty_picture(plants);
  Painter painter(picture, bounds);
  std::vector<Colour> colours;
  for (const PlantKind& kind : plants.kinds()) colours.push_back(colour_in_light(kind));
  for (const TilePlant& plant : plants.plants()) painter.paint(plant, colours[plant.kind]);
  picture.levels.push_back(painter.pixels());
  while (picture.levels.size() < levels) {
    const auto width = static_cast<std::size_t>(picture.width >> (picture.levels.size() - 1));
    picture.levels.push_back(halved(picture.levels.back(), width));
  }
  for (std::size_t level = 0; level < picture.levels.size(); ++level) add_strips(picture, level);
  return picture;
}

}  // namespace desert_sim::render
