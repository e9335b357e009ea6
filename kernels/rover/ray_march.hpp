#pragma once
/// Where a ray meets the height field (height_field.hpp), and how far it gets through plants.
///
/// Over a patch with the heights h_sw, h_se, h_nw, h_ne at its corners the ground is
///
///   h = h_sw + x a + y b + xy a b,   x = h_se − h_sw,  y = h_nw − h_sw,  xy = h_ne − h_se − h_nw + h_sw
///
/// at the fractions a, b of its side, which are linear in t. So the height of the ray above the ground is a
/// quadratic, whose first root is the hit. A ray that is below the ground where it enters a patch is hit
/// there: at t = 0 if the sensor is buried, at the edge of the grid or of unknown ground if it comes in below
/// the surface, and by rounding at the seam of two patches.
///
/// Plants are a medium that begins at the ground and ends at the height of the canopy above it. Its
/// extinction is k D, with the density D of the plants [0 … 1]. Canopy and density are interpolated like the
/// ground. In each patch the height of the ray over the canopy is taken to be linear, and D to be that in
/// the middle of the ray's way through it.
///
/// The ray ends in plants where its optical depth ∫ extinction ds exceeds a given one. For a draw from the
/// exponential distribution of mean 1 that is the law of Beer and Lambert: the share e^(−depth) gets through.
///
/// (src/render/ray_cast.hpp finds single points under a mouse, from below, too, on a host whose heights are
/// somewhere else, cell by cell and in double precision. Here millions of rays meet a terrain on a device.)

#include <cmath>

#include "kernels/base/math.hpp"
#include "kernels/rover/height_field.hpp"
#include "kernels/rover/ray.hpp"
#include "kernels/rover/ray_micro_relief.hpp"

namespace desert_sim::ray_march {

enum class Target { none, ground, plants };

struct Hit {
  Target target = Target::none;
  float t = never;
  float slope_u = 0, slope_v = 0;  ///< of the ground there [m per cell]
};

/// t from which a rising ray is `high` [m] above all tops; `never` for others.
DESERT_HD float end_below_tops(const height_field::View& field, const Ray& r, float high) {
  const height_field::Level& last = field.levels[field.level_count - 1];
  if (!(r.dz > 0.0f) || last.columns * last.rows > 1) return never;
  constexpr float slack = 1e-3f;  // more than rounding comes to [m]
  return (field.tops[last.offset] + (slack + high) - r.z - r.z_rest) / r.dz;
}

/// A bilinear function over a patch.
struct Bilinear {
  float sw, x, y, xy;

  DESERT_HD Bilinear(float south_west, float south_east, float north_west, float north_east)
      : sw(south_west),
        x(south_east - south_west),
        y(north_west - south_west),
        xy((north_east - north_west) - (south_east - south_west)) {}
  DESERT_HD float at(float a, float b) const { return sw + x * a + (y + xy * a) * b; }
};

/// Indices of the cells in the corners of a patch.
struct Corners {
  int sw, se, nw, ne;

  DESERT_HD Corners(const height_field::View& f, int p, int q) {
    const int west = p > 0 ? p - 1 : 0, east = p < f.width ? p : f.width - 1;
    const int south = (q > 0 ? q - 1 : 0) * f.width, north = (q < f.height ? q : f.height - 1) * f.width;
    sw = south + west, se = south + east, nw = north + west, ne = north + east;
  }
  DESERT_HD Bilinear of(const float* layer, float less) const {
    return {layer[sw] - less, layer[se] - less, layer[nw] - less, layer[ne] - less};
  }
};

/// The plants in a patch, as the ray passes them.
struct Canopy {
  float extinction;     ///< of plants of density 1 [1/m]
  float optical_depth;  ///< that is left

  /// Passes the part of the ray from `begin` to `end`, over which its height above the ground goes from
  /// `height_begin` to `height_end`; (a, b) is its place in the patch at `begin`. Returns where the optical
  /// depth is used up, or `never`.
  DESERT_HD float pass(const height_field::View& f, const Corners& corners, const Ray& r, float begin,
                       float end, float a, float b, float height_begin, float height_end) {
    if (f.canopy[corners.sw] + f.canopy[corners.se] + f.canopy[corners.nw] + f.canopy[corners.ne] == 0.0f)
      return never;
    const float length = end - begin;
    const Bilinear canopy = corners.of(f.canopy, 0.0f);
    const float over_begin = height_begin - canopy.at(a, b),
                over_end = height_end - canopy.at(a + length * r.du, b + length * r.dv);
    if (!(over_begin < 0.0f || over_end < 0.0f)) return never;
    const float crossing = over_begin / (over_begin - over_end);  // used where the signs differ only
    const float first = over_begin >= 0.0f ? crossing * length : 0.0f,
                last = over_end >= 0.0f ? crossing * length : length;
    const float middle = 0.5f * (first + last);
    const float density = corners.of(f.density, 0.0f).at(a + middle * r.du, b + middle * r.dv);
    const float per_t = extinction * density * r.metres, depth = per_t * (last - first);
    if (depth >= optical_depth && depth > 0.0f) return begin + first + optical_depth / per_t;
    optical_depth -= depth;
    return never;
  }
};

/// What the ray meets in a patch between `begin` and `end`.
template <class Surface>
DESERT_HD Hit hit_in_patch(const height_field::View& f, const Surface& surface, const Ray& r, int p, int q,
                           float begin, float end, Canopy& canopy) {
  const Corners corners(f, p, q);
  const Bilinear ground = corners.of(f.elevation, r.z);
  const float a = r.u + begin * r.du - static_cast<float>(p - r.patch_x),
              b = r.v + begin * r.dv - static_cast<float>(q - r.patch_y);
  const float slope_u = ground.x + ground.xy * b, slope_v = ground.y + ground.xy * a;
  const float c0 = r.z_rest + begin * r.dz - ground.at(a, b), c1 = r.dz - (slope_u * r.du + slope_v * r.dv),
              c2 = -(ground.xy * r.du * r.dv);
  const float s = surface.first_below({p, q, a, b, r.du, r.dv, c0, c1, c2, r.metres}, end - begin);
  const bool meets_ground = s < never;
  if (f.canopy) {
    const float way = meets_ground ? s : end - begin;
    const float height_end = meets_ground ? 0.0f : c0 + (c1 + c2 * way) * way;
    const float plants = canopy.pass(f, corners, r, begin, begin + way, a, b, c0, height_end);
    if (plants < never) return {Target::plants, plants, 0.0f, 0.0f};
  }
  if (!meets_ground) return {};
  Hit hit{Target::ground, begin + s, slope_u + ground.xy * s * r.dv, slope_v + ground.xy * s * r.du};
  if constexpr (Surface::has_micro_relief) {
    const auto micro_relief = surface.slope(p, q, a + s * r.du, b + s * r.dv);
    hit.slope_u += micro_relief.u;
    hit.slope_v += micro_relief.v;
  }
  return hit;
}

/// The first ground or plants that a ray meets up to t = `end`. `optical_depth`: how much of plants it
/// passes. Blocks of patches over which the ray is higher than all that stands there are passed at once.
/// `surface`: PlainGround or RippledGround.
template <class Surface>
DESERT_HD Hit first_hit(const height_field::View& field, const Surface& surface, const Ray& r, float end,
                        float extinction, float optical_depth) {
  Interval part = part_over_grid(field, r, end);
  part.end = minimum(part.end, end_below_tops(field, r, surface.high));
  if (!(part.begin <= part.end)) return {};
  Canopy canopy{extinction, optical_depth};
  const Axis x{r.u, r.du, r.per_du, r.patch_x}, y{r.v, r.dv, r.per_dv, r.patch_y};
  int i = start_cell(x, part.begin, field.width + 1), j = start_cell(y, part.begin, field.height + 1);
  int level = field.level_count;
  float t = part.begin;
  for (;;) {
    const int shift = 2 * level;
    const float exit_x = x.exit(i, shift), exit_y = y.exit(j, shift);
    const float exit = maximum(t, minimum(minimum(exit_x, exit_y), part.end));
    if (level > 0) {
      const height_field::Level& blocks = field.levels[level - 1];
      const float top =
          field
              .tops[blocks.offset + ((j + r.patch_y) >> shift) * blocks.columns + ((i + r.patch_x) >> shift)];
      if (r.z_rest + (r.dz < 0.0f ? exit : t) * r.dz <= top - r.z + surface.high) {
        --level;
        continue;
      }
    } else {
      const Hit hit = hit_in_patch(field, surface, r, i + r.patch_x, j + r.patch_y, t, exit, canopy);
      if (hit.target != Target::none) return hit;
    }
    if (exit >= part.end) return {};
    const int from_i = i + r.patch_x, from_j = j + r.patch_y;
    if (exit_x <= exit_y) {
      j = y.at(exit, j, shift);
      i = x.beyond(i, shift);
    } else {
      i = x.at(exit, i, shift);
      j = y.beyond(j, shift);
    }
    t = exit;
    const int to_i = i + r.patch_x, to_j = j + r.patch_y;
    if (static_cast<unsigned>(to_i) > static_cast<unsigned>(field.width) ||
        static_cast<unsigned>(to_j) > static_cast<unsigned>(field.height))
      return {};
    const int changed = ((from_i ^ to_i) | (from_j ^ to_j)) >> (shift + 2);
    if (changed != 0 && level < field.level_count) ++level;
  }
}

}  // namespace desert_sim::ray_march
