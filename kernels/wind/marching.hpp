#pragma once
/// Marches over the surface along the wind: where their samples lie between cells, and the height there.
/// Positions are 16.16 fixed point, and interpolation sums in a symmetric order, so that mirrored or rotated
/// terrain gives the same bits.

#include "kernels/base/grid.hpp"
#include "kernels/base/math.hpp"
#include "kernels/base/quanta.hpp"

namespace desert_sim::marching {

/// A march along a straight line. A step advances by one column of cells, or by one row where the line
/// crosses rows faster; the sample lies between two cells of that column or row.
struct Line {
  int heading;  ///< ±1: column by column towards ±x; ±2: row by row towards ±y; 0: no march
  int drift;    ///< displacement across the heading per step [cells], 16.16 fixed point, −1 … 1

  /// The line against the wind (u, v), which must not be 0. The drift is rounded to 2⁻¹² cells per step, so
  /// that winds which differ only by rounding have the same line.
  DESERT_HD static Line against(float u, float v) {
    const bool along_x = fabsf(u) >= fabsf(v);
    const float along = along_x ? u : v, across = along_x ? v : u;
    return {(along_x ? 1 : 2) * (along > 0.0f ? -1 : 1),
            -16 * round_to_int(4096.0f * (across / fabsf(along)))};
  }
  /// Not heading & 1: GCC 12 has no vectors of whole numbers that become truth values.
  DESERT_HD bool along_x() const { return heading == 1 || heading == -1; }
  DESERT_HD int step() const { return heading > 0 ? 1 : -1; }
  /// Length of a step [cells], 1 … √2.
  DESERT_HD float cells_per_step() const {
    const float slope = static_cast<float>(drift) * (1.0f / 65536.0f);
    return sqrtf(1.0f + slope * slope);
  }
  /// Whether the line is more than 3.6 degrees off an axis. If not, a step is one cell long within 0.2 %.
  DESERT_HD bool is_oblique() const { return drift > 65536 / 16 || drift < -65536 / 16; }
  /// Offset of the cell at or before the sample of step j from the first cell of the march.
  DESERT_HD int dx(int j) const { return along_x() ? j * step() : (j * drift) >> 16; }
  DESERT_HD int dy(int j) const { return along_x() ? (j * drift) >> 16 : j * step(); }
};

/// Position of a sample, (x, y) + (dx, dy)/65536 [cells]: the cell to its south-west, and the fractions.
struct SamplePosition {
  int x, y;
  float fx, fy;
  DESERT_HD SamplePosition(int cell_x, int cell_y, int dx, int dy)
      : x(cell_x + (dx >> 16)), y(cell_y + (dy >> 16)), fx(fraction(dx)), fy(fraction(dy)) {}
};

/// Bilinear height between the four cells around a sample.
DESERT_HD float height_at(const Grid& g, const float* h, const SamplePosition& p) {
  const float h00 = h[sample_index(g, p.x, p.y)], h10 = h[sample_index(g, p.x + 1, p.y)];
  const float h01 = h[sample_index(g, p.x, p.y + 1)], h11 = h[sample_index(g, p.x + 1, p.y + 1)];
  const float a = h00 * ((1.0f - p.fx) * (1.0f - p.fy)), b = h10 * (p.fx * (1.0f - p.fy));
  const float c = h01 * ((1.0f - p.fx) * p.fy), d = h11 * (p.fx * p.fy);
  return (a + d) + (b + c);
}

}  // namespace desert_sim::marching
