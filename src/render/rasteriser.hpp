#pragma once
/// Draws meshes into a picture in memory, without a graphics card: the nearest surface wins (z-buffer).

#include <vector>

#include "src/render/camera.hpp"
#include "src/render/mesh.hpp"

namespace desert_sim::render {

/// Colours of rows of pixels, the upper left one first.
struct Picture {
  int width = 0, height = 0;
  std::vector<PackedColour> pixels;
};

class Rasteriser {
 public:
  /// Every pixel is the mean of `samples` × `samples` points.
  Rasteriser(int width, int height, int samples);

  int width() const { return width_; }    ///< with all samples
  int height() const { return height_; }  ///< with all samples

  /// Fills the picture, at any depth, with the colours of a background that has a pixel for each sample.
  void clear(const std::vector<PackedColour>& background);
  /// Triangles whose colours hide what is behind. Heights are multiplied by `exaggeration`. Triangles with a
  /// corner behind the camera are left out.
  void draw(const Mesh& mesh, const Projection& projection, double exaggeration);
  /// Triangles whose colours cover what is behind them by their alpha, and that hide nothing.
  void blend(const Mesh& mesh, const Projection& projection, double exaggeration);
  /// Lines, as `draw`; those on a surface are seen.
  void draw_lines(const Mesh& mesh, const Projection& projection, double exaggeration);

  Picture picture() const;

 private:
  struct Corner;
  std::vector<Corner> corners_of(const Mesh& mesh, const Projection& projection, double exaggeration) const;
  template <class Paint>
  void fill(const Corner& a, const Corner& b, const Corner& c, const Paint& paint);

  int width_, height_, samples_;
  std::vector<float> depth_;
  std::vector<PackedColour> pixels_;
};

}  // namespace desert_sim::render
