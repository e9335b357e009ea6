#pragma once
/// The height field in which beams of range sensors end (beams.hpp): heights of the ground, plants and
/// airborne sand on the device, with what lets a beam pass many cells at once.
///
/// A *patch* is the square between four neighbouring centres of cells, over which the ground is interpolated
/// bilinearly. Patch (p, q) has cell (p − 1, q − 1) in its south-west corner; indices beyond the grid are
/// clamped, so that the surface is constant beyond the outermost centres: it is that of LayerMap::value(). A
/// grid of W × H cells has (W + 1) × (H + 1) patches.
///
///   tops        max over a block of 4ᵏ × 4ᵏ patches, k = 1, 2, …, of elevation + height of the plants, at
///               all corners of its patches: a beam that is higher over the block does not meet anything in
///               it (Tevs, Ihrke, Seidel 2008, Maximum mipmaps)
///   dust        mean of the airborne sand over a block of 8 × 8 cells [m], and of the elevation there [m]

#include "kernels/base/grid.hpp"

namespace desert_sim::height_field {

constexpr int levels_at_most = 8;  ///< of tops; side of a block of the last: 4⁸ = 65536 patches
constexpr int dust_side = 8;       ///< [cells]

/// Cells x … x + width − 1, y … y + height − 1.
struct Rectangle {
  int x = 0, y = 0, width = 0, height = 0;
};

/// The blocks of a level lie row-major in `tops` from `offset` on.
struct Level {
  int offset = 0, columns = 0, rows = 0;
};

/// Pointers to device memory, passed to laws by value. Layers have one value a cell, row-major from the
/// south-west. `canopy` and `density` are null where there are no plants, `dust` where no sand is in the air.
struct View {
  int width = 0, height = 0;           ///< [cells]
  const float* elevation = nullptr;    ///< [m]; NaN: unknown, beams go through
  const float* canopy = nullptr;       ///< height of plants above the ground [m]
  const float* density = nullptr;      ///< of plants [0 … 1]
  const float* dust = nullptr;         ///< of the blocks [m]
  const float* dust_ground = nullptr;  ///< of the blocks [m]; NaN where no cell is known
  const float* tops = nullptr;         ///< [m]; −infinity where no height is known
  int level_count = 0;
  Level levels[levels_at_most];  ///< levels[k − 1] has blocks of 4ᵏ × 4ᵏ patches
};

DESERT_HD int blocks_along(int cells, int side) { return (cells + side - 1) / side; }

/// Fills in the levels of a grid whose width and height are set; returns the number of tops.
int plan_levels(View& view);

/// Copies a rectangle of values into a layer. `sane` says what becomes of values that a layer cannot have:
/// of the elevation, numbers beyond ±1e9 become NaN; of other layers, what is not above 0 (NaN, too) becomes
/// 0. `as_they_are` copies them.
enum class Sane { heights, amounts, as_they_are };
template <class E>
void write_rectangle(E& exec, const float* values, const Rectangle& cells, Sane sane, int width,
                     float* layer);

/// Computes the tops of all blocks anew that have a corner in the rectangle. `tops` is what the view refers
/// to.
template <class E>
void refresh_tops(E& exec, const View& view, const Rectangle& cells, float* tops);

/// Computes the blocks of dust anew that have a cell in the rectangle.
template <class E>
void refresh_dust(E& exec, const View& view, const float* airborne_sand, const Rectangle& cells, float* dust,
                  float* ground);

}  // namespace desert_sim::height_field
