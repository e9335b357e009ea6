#pragma once
/// What micro-relief adds to the surface that is bilinear between the centres of cells [m]: Paris et al.
/// 2019, section 6, S̃ = S + ripples + bumps.
///
///   offset = mobile · (level · s(S/H) · (1 − sheltered) · ripple + s(S/B) · bump)
///
/// S is the depth of sand: ripples fade where sand is thinner than they are high, bumps likewise. `mobile`
/// and `level` are interpolated between cells (Cells); where they are 0, the offset is 0 exactly. s is
/// smooth_step().

#include "kernels/micro_relief/bumps.hpp"

namespace desert_sim::micro_relief {

struct Relief {
  Cells cells;
  Ripples ripples;
  Bumps bumps;

  /// With patches and bumps computed where they are needed. `x`, `y`: metres from the south-west corner.
  DESERT_HD float offset(double x, double y) const {
    return offset(
        x, y, [this](int i, int j) { return patch(i, j); }, [this](int i, int j) { return bump(i, j); });
  }
  /// Of a square next to one on the terrain.
  DESERT_HD RipplePatch patch(int i, int j) const {
    return ripples.patch(cells, ripples.lattice.column(i), ripples.lattice.row(j));
  }
  DESERT_HD Bump bump(int i, int j) const {
    return bumps.bump(cells, ripples, bumps.lattice.column(i), bumps.lattice.row(j));
  }
  /// With patches and bumps from somewhere else, for many places.
  template <class PatchOf, class BumpOf>
  DESERT_HD float offset(double x, double y, const PatchOf& patch_of, const BumpOf& bump_of) const {
    const double px = rounded(x), py = rounded(y);
    const Cells::Corners at = cells.corners(px, py);
    const float mobile = cells.value(cells.mobile, at), depth = cells.value(cells.sand, at);
    if (!(mobile > 0.0f && depth > 0.0f)) return 0.0f;
    Bumps::Heap heap{0.0f, 0.0f};
    if (bumps.height > 0.0f) {
      heap = bumps.heap(bumps.lattice.square(px, py), bump_of);
      heap.height *= smooth_step(depth / bumps.height);
    }
    const float bare = cells.value(cells.level, at) * (1.0f - heap.sheltered);
    if (!(bare > 0.0f && ripples.prevalence > 0.0f && ripples.size.steepness > 0.0f))
      return mobile * heap.height;
    const Ripples::Wave wave = ripples.wave(ripples.lattice.square(px, py), patch_of);
    if (!(wave.height > 0.0f)) return mobile * heap.height;
    const float ripple = wave.height * smooth_step(depth / wave.height) * wave.shape;
    return mobile * (bare * ripple + heap.height);
  }
};

}  // namespace desert_sim::micro_relief
