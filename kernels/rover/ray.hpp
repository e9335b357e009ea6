#pragma once
/// Rays over a height field (height_field.hpp), and how they go through its grid block by block.
///
/// Coordinates are those of patches, in units of the cell size, relative to the patch in which the ray
/// begins: however far away the origin of the grid and however large the grid is, rounding is that of
/// distances along the ray. Along the ray a place is origin + t · direction, and t is what "distance" means
/// here.

#include <cmath>

#include "kernels/base/math.hpp"
#include "kernels/rover/height_field.hpp"

namespace desert_sim::ray_march {

constexpr float never = 3.0e38f;

/// A ray in units of cells horizontally and metres vertically, for each unit of t.
struct Ray {
  float u, v;    ///< of the origin, relative to the south-west corner of patch (patch_x, patch_y)
  float du, dv;  ///< neither is 0
  float per_du, per_dv;
  int patch_x, patch_y;
  float z, z_rest;  ///< height of the origin [m] as a float, and what that leaves of it
  float dz;         ///< [m]
  float metres;     ///< length of the direction
};

/// The largest integer that is not above a number; |x| < 2³¹.
DESERT_HD int floor_to_int(float x) {
  const int n = static_cast<int>(x);
  return n - (x < static_cast<float>(n) ? 1 : 0);
}

/// A division by 0 is avoided by a direction that is off by less than any rounding.
DESERT_HD float not_zero(float x) { return fabsf(x) < 1e-30f ? 1e-30f : x; }

/// The part of a ray that is over a grid of so many cells; empty if begin > end.
struct Interval {
  float begin, end;
  DESERT_HD void clip(float at_low, float at_high) {
    begin = maximum(begin, minimum(at_low, at_high));
    end = minimum(end, maximum(at_low, at_high));
  }
};
DESERT_HD Interval part_over_grid(const height_field::View& field, const Ray& r, float end) {
  Interval part{0.0f, end};  // the grid begins and ends in the middle of the outermost patches
  const float west = 0.5f - static_cast<float>(r.patch_x), south = 0.5f - static_cast<float>(r.patch_y);
  part.clip((west - r.u) * r.per_du, (west + static_cast<float>(field.width) - r.u) * r.per_du);
  part.clip((south - r.v) * r.per_dv, (south + static_cast<float>(field.height) - r.v) * r.per_dv);
  return part;
}

/// Walks along an axis of a grid of blocks. Cells are counted from the one in which the ray begins.
struct Axis {
  float origin, direction, per_direction;
  int begin;  ///< absolute index of the cell that is counted as 0

  /// First cell of the block of 2^shift cells that has cell n.
  DESERT_HD int first(int n, int shift) const { return ((n + begin) >> shift << shift) - begin; }
  /// t at which the ray leaves that block.
  DESERT_HD float exit(int n, int shift) const {
    const int edge = first(n, shift) + (direction > 0.0f ? 1 << shift : 0);
    return (static_cast<float>(edge) - origin) * per_direction;
  }
  /// The cell behind that block.
  DESERT_HD int beyond(int n, int shift) const {
    return direction > 0.0f ? first(n, shift) + (1 << shift) : first(n, shift) - 1;
  }
  /// The cell at t, which rounding does not put outside the block of n, nor behind n.
  DESERT_HD int at(float t, int n, int shift) const {
    const int place = floor_to_int(origin + t * direction), low = first(n, shift);
    const int high = low + (1 << shift) - 1;
    return direction > 0.0f ? (place < n ? n : (place > high ? high : place))
                            : (place > n ? n : (place < low ? low : place));
  }
};

DESERT_HD int start_cell(const Axis& axis, float t, int cells) {
  const int n = floor_to_int(axis.origin + t * axis.direction) + axis.begin;
  return clamp_index(n, cells) - axis.begin;
}

}  // namespace desert_sim::ray_march
