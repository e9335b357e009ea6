#pragma once
/// How far rays get through airborne sand.
///
/// It is a medium with the extinction K a, with a the mean airborne sand of a block of cells [m], from the
/// mean ground of the block up to a given height. A ray ends where its optical depth ∫ K a ds exceeds a given
/// one, as in plants (ray_march.hpp).

#include "kernels/rover/ray.hpp"

namespace desert_sim::ray_march {

/// Airborne sand, as rays pass it.
struct Dust {
  float extinction;  ///< for each metre of airborne sand [1/m]
  float height;      ///< above the ground up to which it fills the air [m]
};

/// t at which the optical depth of airborne sand that a ray has passed exceeds `optical_depth`; `never` if
/// that is not up to t = `end`.
DESERT_HD float end_in_dust(const height_field::View& field, const Ray& r, float end, const Dust& dust,
                            float optical_depth) {
  constexpr float per_side = 1.0f / height_field::dust_side;
  const Interval part = part_over_grid(field, r, end);
  if (!(part.begin <= part.end)) return never;
  const int columns = height_field::blocks_along(field.width, height_field::dust_side),
            rows = height_field::blocks_along(field.height, height_field::dust_side);
  // Patch p begins half a cell before cell p, in the middle of cell p − 1.
  const auto axis = [=](int patch, float place, float direction, float per_direction) {
    const int block = patch / height_field::dust_side;
    const float cell = static_cast<float>(patch - block * height_field::dust_side) - 0.5f + place;
    return Axis{cell * per_side, direction * per_side, per_direction * height_field::dust_side, block};
  };
  const Axis x = axis(r.patch_x, r.u, r.du, r.per_du), y = axis(r.patch_y, r.v, r.dv, r.per_dv);
  int i = start_cell(x, part.begin, columns), j = start_cell(y, part.begin, rows);
  const float per_dz = 1.0f / not_zero(r.dz);
  for (float t = part.begin;;) {
    const float exit_x = x.exit(i, 0), exit_y = y.exit(j, 0);
    const float exit = maximum(t, minimum(minimum(exit_x, exit_y), part.end));
    const int block = (j + y.begin) * columns + i + x.begin;
    // The ray crosses the top of the layer at `crossing`, upwards or downwards.
    const float crossing = (field.dust_ground[block] + dust.height - r.z - r.z_rest) * per_dz;
    const float first = per_dz < 0.0f ? maximum(t, crossing) : t,
                last = per_dz < 0.0f ? exit : minimum(exit, crossing);
    const float per_t = dust.extinction * field.dust[block] * r.metres, depth = per_t * (last - first);
    if (depth > 0.0f) {  // not where the ground is unknown
      if (depth >= optical_depth) return first + optical_depth / per_t;
      optical_depth -= depth;
    }
    if (exit >= part.end) return never;
    (exit_x <= exit_y ? i : j) = exit_x <= exit_y ? x.beyond(i, 0) : y.beyond(j, 0);
    if (static_cast<unsigned>(i + x.begin) >= static_cast<unsigned>(columns) ||
        static_cast<unsigned>(j + y.begin) >= static_cast<unsigned>(rows))
      return never;
    t = exit;
  }
}

}  // namespace desert_sim::ray_march
