#pragma once
/// A tile in a GPU's shared memory, and the sweeps over it. tile.cu gives an overview.

#include "kernels/avalanching/tile.hpp"
#include "kernels/backend/vec4.hpp"

namespace desert_sim::avalanching::tuned {

constexpr int side = Tiles::side, patches = RelaxTile::patches, threads = patches * patches;
constexpr int warps = threads / 32;

/// One value for each cell of a tile. Columns 0, 4, 8 … are stored apart from columns 1, 5, 9 … and so on,
/// and the stride of rows is such that the cells which the threads of a warp access at once lie in 32
/// different banks, however the patches are shifted.
struct PerCell {
  static constexpr int stride = patches + 2;
  float values[Patch::side][side * stride];
  __device__ float& at(int x, int y) { return values[x % Patch::side][y * stride + x / Patch::side]; }
};

struct Shared {
  PerCell h, ground, drop;
  Vec4<Quanta> base[Patch::side][threads];  ///< part of a cell's sand that does not change with its height
  float share[side + Patch::side];          ///< ω of each gap, numbered as in GapOmega
  Range range[warps];
  int moved[2][warps];  ///< by warp: 0 nothing, 1 something, 2 much; even and odd sweeps
};

/// Index of a patch's cell among its registers.
struct InRegisters {
  __device__ constexpr int operator()(int row, int column) const { return row * Patch::side + column; }
};

/// Relaxes the pairs, or quads, of this thread's patch. `walls`: whether the tile has any; for quads. Returns
/// the largest amount that one of them moves.
template <bool deep, bool quads>
__device__ __forceinline__ float sweep_patch(Shared& shared, const PatchShift& shift, bool walls) {
  constexpr unsigned bytes = sizeof(float), row_bytes = PerCell::stride * bytes;
  const unsigned px = threadIdx.x % patches, py = threadIdx.x / patches;
  const unsigned next_x = (px + 1) % patches, next_y = (py + 1) % patches;
  unsigned columns[Patch::side], rows[Patch::side];  // byte offsets in PerCell: an address is one addition
#pragma unroll
  for (int n = 0; n < Patch::side; ++n) {
    const unsigned x = static_cast<unsigned>(shift.x + n), y = static_cast<unsigned>(shift.y + n);
    columns[n] = x % Patch::side * (side * row_bytes) + (x < Patch::side ? px : next_x) * bytes;
    rows[n] = y % Patch::side * row_bytes + (y < Patch::side ? py : next_y) * (Patch::side * row_bytes);
  }
  const bool transposed = quads && shift.transposed;  // the patch lies so in the registers
#pragma unroll
  for (int n = 0; n < Patch::side; ++n)
    if (transposed) {
      const unsigned row = rows[n];
      rows[n] = columns[n], columns[n] = row;
    }
  const auto at = [&](PerCell& values, int n) -> float& {
    char* const first = reinterpret_cast<char*>(values.values);
    return *reinterpret_cast<float*>(first + (rows[n / Patch::side] + columns[n % Patch::side]));
  };
  float h[Patch::cells], ground[Patch::cells], drop[Patch::cells];
#pragma unroll
  for (int n = 0; n < Patch::cells; ++n) {
    h[n] = at(shared.h, n);
    if (!deep) ground[n] = at(shared.ground, n);
    drop[n] = at(shared.drop, n);
  }
  Shares<1> shares;
#pragma unroll
  for (int n = 0; n + 1 < Patch::side; ++n) {
    shares.x[n][0] = shared.share[px * Patch::side + shift.x + n];
    shares.y[n] = shared.share[py * Patch::side + shift.y + n];
  }
  float max_moved = 0.0f;
  if constexpr (quads)
    QuadsOfPatches<1, deep, InRegisters>{h, ground, drop, {}, {shares, transposed}, &max_moved, walls}
        .relax();
  else
    PairsOfPatches<1, deep, InRegisters>{h, ground, drop, {}, shares, &max_moved}.relax();
#pragma unroll
  for (int n = 0; n < Patch::cells; ++n) at(shared.h, n) = h[n];
  return max_moved;
}

/// Whether the kernel has separate code for each of the four shifts, in which all offsets are constants. This
/// pays where tiles take many sweeps; with few, fetching the instructions takes longer than it saves.
enum class ShiftCode { shared_by_shifts, one_per_shift };

template <bool deep, bool quads, ShiftCode code>
__device__ float sweep_patch(Shared& shared, const PatchShift& shift, bool walls) {
  static_assert(Patch::side == 4);
  if constexpr (code == ShiftCode::one_per_shift) switch (shift.x) {
      case 0:
        return sweep_patch<deep, quads>(shared, PatchShift(0, shift.transposed), walls);
      case 1:
        return sweep_patch<deep, quads>(shared, PatchShift(1, shift.transposed), walls);
      case 2:
        return sweep_patch<deep, quads>(shared, PatchShift(2, shift.transposed), walls);
      default:
        return sweep_patch<deep, quads>(shared, PatchShift(3, shift.transposed), walls);
    }
  return sweep_patch<deep, quads>(shared, shift, walls);
}

/// Sweeps over the loaded tile until it is at rest or may stop. Returns whether anything moved.
template <bool deep, bool quads, ShiftCode code>
__device__ bool relax(const RelaxTile& law, Shared& shared, const Units& units, bool walls) {
  const float threshold = units.drop(law.continue_threshold, law.level.quanta_per_cell);
  return law.relax([&](int n, const PatchShift& shift) {
    const float max_moved = sweep_patch<deep, quads, code>(shared, shift, walls);
    const bool any = __any_sync(0xffffffffu, max_moved > 0.0f),
               any_much = __any_sync(0xffffffffu, max_moved > threshold);
    if (threadIdx.x % 32 == 0) shared.moved[n % 2][threadIdx.x / 32] = any_much ? 2 : (any ? 1 : 0);
    __syncthreads();
    int block_moved = 0;
#pragma unroll
    for (int k = 0; k < warps; ++k) block_moved = max(block_moved, shared.moved[n % 2][k]);
    return static_cast<RelaxTile::Moved>(block_moved);
  });
}

}  // namespace desert_sim::avalanching::tuned
