#pragma once
/// The shapes of a brush: which cells it covers, and with what weight, 0 … 1. Lengths are in cells; a shape's
/// coordinates u (along its angle) and v (across) count from the centre of the rectangle that bounds it.
///
///   circle, ellipse   r = |(u/a, v/b)|
///   rectangle         r = max(|u|/a, |v|/b)
///   capsule           r = distance to the stroke's axis / a
///   polygon           inside by the even-odd rule; depth = distance to its nearest edge
///   patch             a rectangle; depth = distance to its nearest edge
///
/// A shape with r has weight 1 up to r = `inner`, from where it falls linearly to 0 at r = 1. The weight of a
/// shape with a depth rises linearly from 0 at the edge to 1 at depth `falloff`.

#include "kernels/base/math.hpp"

namespace desert_sim {

enum class BrushShape : int { circle, ellipse, rectangle, polygon, capsule, patch };
constexpr const char* brush_shapes[] = {"circle", "ellipse", "rectangle", "polygon", "capsule", "patch"};

/// Meaning of the values of a patch: heights that are added to the brush's value, or weights.
enum class PatchUse : int { heights, mask };
constexpr const char* patch_uses[] = {"heights", "mask"};

namespace brush {

struct Point {
  float x, y;
};

/// Distance from a point to the segment between `from` and `to`.
DESERT_HD float distance_to_segment(Point p, Point from, Point to) {
  const float dx = to.x - from.x, dy = to.y - from.y, px = p.x - from.x, py = p.y - from.y;
  const float length2 = dx * dx + dy * dy;
  const float t = length2 > 0.0f ? clamp((px * dx + py * dy) / length2, 0.0f, 1.0f) : 0.0f;
  return hypotenuse(px - t * dx, py - t * dy);
}

/// Values on a grid of their own. Row 0 lies on the side of +v, like the top row of a picture.
struct PatchView {
  const float* values;
  int columns, rows;

  /// Bilinear interpolation between the centres of the values, constant beyond the outermost; `across` and
  /// `down` are 0 … 1.
  DESERT_HD float at(float across, float down) const {
    const float x = clamp(across * columns - 0.5f, 0.0f, static_cast<float>(columns - 1));
    const float y = clamp(down * rows - 0.5f, 0.0f, static_cast<float>(rows - 1));
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const int x1 = x0 + 1 < columns ? x0 + 1 : x0, y1 = y0 + 1 < rows ? y0 + 1 : y0;
    const float fx = x - x0, fy = y - y0;
    return lerp(lerp(values[y0 * columns + x0], values[y0 * columns + x1], fx),
                lerp(values[y1 * columns + x0], values[y1 * columns + x1], fx), fy);
  }
};

struct Shape {
  BrushShape kind;
  float a, b;      ///< semi-axes or half sides; a is the radius of a capsule
  float cos, sin;  ///< of the angle of the first axis
  float inner, falloff;
  const Point* vertices;  ///< vertices of a polygon, or the two ends of a capsule's axis
  int count;
  PatchUse use;
  PatchView patch;

  DESERT_HD float along(Point p) const { return p.x * cos + p.y * sin; }
  DESERT_HD float across(Point p) const { return p.y * cos - p.x * sin; }
  DESERT_HD bool has_depth() const { return kind == BrushShape::polygon || kind == BrushShape::patch; }

  /// Relative distance from the centre: 1 on the edge of the shape grown by `by` cells.
  DESERT_HD float relative_distance(Point p, float by) const {
    if (kind == BrushShape::capsule) return distance_to_segment(p, vertices[0], vertices[1]) / (a + by);
    const float u = along(p) / (a + by), v = across(p) / (b + by);
    if (kind == BrushShape::circle || kind == BrushShape::ellipse) return hypotenuse(u, v);
    return maximum(fabsf(u), fabsf(v));
  }

  /// Distance to the polygon's nearest edge.
  DESERT_HD float distance_to_edge(Point p) const {
    float nearest = distance_to_segment(p, vertices[count - 1], vertices[0]);
    for (int n = 1; n < count; ++n)
      nearest = minimum(nearest, distance_to_segment(p, vertices[n - 1], vertices[n]));
    return nearest;
  }
  DESERT_HD bool in_polygon(Point p) const {
    bool inside = false;
    for (int n = 0, before = count - 1; n < count; before = n++) {
      const Point v = vertices[n], w = vertices[before];
      if ((v.y > p.y) != (w.y > p.y) && p.x < v.x + (p.y - v.y) * (w.x - v.x) / (w.y - v.y)) inside = !inside;
    }
    return inside;
  }

  /// Whether the point lies in the shape grown by `by` cells on every side.
  DESERT_HD bool covers(Point p, float by) const {
    if (kind != BrushShape::polygon) return relative_distance(p, by) <= 1.0f;
    return in_polygon(p) || (by > 0.0f && distance_to_edge(p) <= by);
  }

  DESERT_HD float sample(Point p) const {
    return patch.at(0.5f + 0.5f * along(p) / a, 0.5f - 0.5f * across(p) / b);
  }

  DESERT_HD float weight(Point p) const {
    if (!has_depth()) {
      const float r = relative_distance(p, 0.0f);
      if (r > 1.0f) return 0.0f;
      return r <= inner ? 1.0f : (1.0f - r) / (1.0f - inner);
    }
    if (!covers(p, 0.0f)) return 0.0f;
    float w = 1.0f;
    if (falloff > 0.0f) {
      const float depth = kind == BrushShape::polygon ? distance_to_edge(p)
                                                      : minimum(a - fabsf(along(p)), b - fabsf(across(p)));
      w = minimum(depth / falloff, 1.0f);
    }
    return kind == BrushShape::patch && use == PatchUse::mask ? w * sample(p) : w;
  }

  /// What a patch of heights adds to the brush's value [m].
  DESERT_HD float height(Point p) const {
    return kind == BrushShape::patch && use == PatchUse::heights ? sample(p) : 0.0f;
  }
};

}  // namespace brush
}  // namespace desert_sim
