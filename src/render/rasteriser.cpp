#include "src/render/rasteriser.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace desert_sim::render {

struct Rasteriser::Corner {
  float column, row, depth;
  float channel[4];  ///< red, green, blue, alpha: 0…255
  bool in_front;
};

namespace {

constexpr float farthest = std::numeric_limits<float>::max();

PackedColour packed(const float channel[4]) {
  PackedColour colour = 0;
  for (int n = 0; n < 4; ++n)
    colour |= static_cast<PackedColour>(std::clamp(channel[n] + 0.5f, 0.0f, 255.0f)) << (8 * n);
  return colour;
}

float channel_of(PackedColour colour, int n) { return static_cast<float>(colour >> (8 * n) & 255); }

}  // namespace

Rasteriser::Rasteriser(int width, int height, int samples)
    : width_(width * samples),
      height_(height * samples),
      samples_(samples),
      depth_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), farthest),
      pixels_(depth_.size(), 0) {}

void Rasteriser::clear(const std::vector<PackedColour>& background) {
  std::fill(depth_.begin(), depth_.end(), farthest);
  pixels_ = background;
}

std::vector<Rasteriser::Corner> Rasteriser::corners_of(const Mesh& mesh, const Projection& projection,
                                                       double exaggeration) const {
  std::vector<Corner> corners;
  corners.reserve(mesh.vertices.size());
  for (const Vertex& v : mesh.vertices) {
    const PicturePoint p = projection.project(
        {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z) * exaggeration});
    Corner corner{
        static_cast<float>(p.column), static_cast<float>(p.row), static_cast<float>(p.depth), {}, p.in_front};
    for (int n = 0; n < 4; ++n) corner.channel[n] = channel_of(v.colour, n);
    corners.push_back(corner);
  }
  return corners;
}

/// Calls paint(pixel, depth, channels) for each point in the triangle that nothing hides. Colours are linear
/// in the picture: triangles of a terrain are too small for the perspective within one to be seen.
template <class Paint>
void Rasteriser::fill(const Corner& a, const Corner& b, const Corner& c, const Paint& paint) {
  if (!(a.in_front && b.in_front && c.in_front)) return;
  const float area = (b.column - a.column) * (c.row - a.row) - (c.column - a.column) * (b.row - a.row);
  if (!(std::abs(area) > 1e-12f)) return;
  const auto first = [](float x) { return std::max(0.0f, std::ceil(x - 0.5f)); };
  const float left = first(std::min({a.column, b.column, c.column})),
              top = first(std::min({a.row, b.row, c.row}));
  const float right =
                  std::min(std::max({a.column, b.column, c.column}) - 0.5f, static_cast<float>(width_ - 1)),
              bottom = std::min(std::max({a.row, b.row, c.row}) - 0.5f, static_cast<float>(height_ - 1));
  for (float row = top; row <= bottom; ++row)
    for (float column = left; column <= right; ++column) {
      const float x = column + 0.5f, y = row + 0.5f;
      const float of_a = ((b.column - x) * (c.row - y) - (c.column - x) * (b.row - y)) / area;
      const float of_b = ((c.column - x) * (a.row - y) - (a.column - x) * (c.row - y)) / area;
      const float of_c = 1 - of_a - of_b;
      if (of_a < 0 || of_b < 0 || of_c < 0) continue;
      const std::size_t pixel =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(column);
      const float depth = of_a * a.depth + of_b * b.depth + of_c * c.depth;
      if (depth > depth_[pixel]) continue;
      float channel[4];
      for (int n = 0; n < 4; ++n)
        channel[n] = of_a * a.channel[n] + of_b * b.channel[n] + of_c * c.channel[n];
      paint(pixel, depth, channel);
    }
}

void Rasteriser::draw(const Mesh& mesh, const Projection& projection, double exaggeration) {
  const std::vector<Corner> corners = corners_of(mesh, projection, exaggeration);
  for (std::size_t n = 0; n + 2 < mesh.indices.size(); n += 3)
    fill(corners[mesh.indices[n]], corners[mesh.indices[n + 1]], corners[mesh.indices[n + 2]],
         [this](std::size_t pixel, float depth, const float channel[4]) {
           depth_[pixel] = depth;
           pixels_[pixel] = packed(channel);
         });
}

void Rasteriser::blend(const Mesh& mesh, const Projection& projection, double exaggeration) {
  const std::vector<Corner> corners = corners_of(mesh, projection, exaggeration);
  for (std::size_t n = 0; n + 2 < mesh.indices.size(); n += 3)
    fill(corners[mesh.indices[n]], corners[mesh.indices[n + 1]], corners[mesh.indices[n + 2]],
         [this](std::size_t pixel, float, const float channel[4]) {
           const float alpha = channel[3] / 255.0f;
           float mixed[4] = {0, 0, 0, 255};
           for (int k = 0; k < 3; ++k) {
             const float behind = channel_of(pixels_[pixel], k);
             mixed[k] = behind + alpha * (channel[k] - behind);
           }
           pixels_[pixel] = packed(mixed);
         });
}

void Rasteriser::draw_lines(const Mesh& mesh, const Projection& projection, double exaggeration) {
  constexpr float nearer = 1.0005f;  // than it is, so that the surface below does not hide the line
  const std::vector<Corner> corners = corners_of(mesh, projection, exaggeration);
  for (std::size_t n = 0; n + 1 < mesh.indices.size(); n += 2) {
    const Corner &a = corners[mesh.indices[n]], &b = corners[mesh.indices[n + 1]];
    if (!(a.in_front && b.in_front)) continue;
    const float length = std::max(std::abs(b.column - a.column), std::abs(b.row - a.row));
    const int steps = static_cast<int>(std::min(length, static_cast<float>(width_ + height_))) + 1;
    for (int step = 0; step <= steps; ++step) {
      const float share = static_cast<float>(step) / static_cast<float>(steps);
      const float column = a.column + share * (b.column - a.column), row = a.row + share * (b.row - a.row);
      if (!(column >= 0 && row >= 0 && column < static_cast<float>(width_) &&
            row < static_cast<float>(height_)))
        continue;
      const std::size_t pixel =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(column);
      const float depth = (a.depth + share * (b.depth - a.depth)) * nearer;
      if (depth <= depth_[pixel]) pixels_[pixel] = packed(a.channel);
    }
  }
}

Picture Rasteriser::picture() const {
  Picture picture{width_ / samples_, height_ / samples_, {}};
  picture.pixels.reserve(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
  const auto share = 1.0f / static_cast<float>(samples_ * samples_);
  for (int row = 0; row < picture.height; ++row)
    for (int column = 0; column < picture.width; ++column) {
      float sum[4] = {0, 0, 0, 0};
      for (int y = 0; y < samples_; ++y)
        for (int x = 0; x < samples_; ++x) {
          const PackedColour sample =
              pixels_[static_cast<std::size_t>(row * samples_ + y) * static_cast<std::size_t>(width_) +
                      static_cast<std::size_t>(column * samples_ + x)];
          for (int n = 0; n < 4; ++n) sum[n] += share * channel_of(sample, n);
        }
      picture.pixels.push_back(packed(sum));
    }
  return picture;
}

}  // namespace desert_sim::render
