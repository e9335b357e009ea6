#pragma once
/// Transport of suspended sediment through the virtual pipes (donor-cell scheme): a cell that gives a share
/// of its water gives the same share of its sediment.
///
///   S_i += Σ_in S_j q_j/w_j − Σ_out S_i q_i/w_i
///
/// q is the depth of water that passes a face in a sub-step. So sediment comes only to where water comes. The
/// published method (Nilles 2025 §3.4.1) moves it by U Δt, which lands on dry ground beside a stream that is
/// fast or bends, and builds ridges one cell wide there.

#include "kernels/field/ledger.hpp"
#include "kernels/water/pipe_flow.hpp"

namespace desert_sim::virtual_pipes {

template <bool inside>
struct CarrySediment {
  Flow<inside> flow;
  LedgerView ledger;

  /// Sediment [quanta, rounded down] that leaves cell `from` with so much of its water [quanta].
  DESERT_HD Quanta sediment_with(int from, Quanta water) const {
    constexpr float guard = 1.0f - 1.0f / 1048576.0f;  // four shares are rounded
    const float share = static_cast<float>(water) / static_cast<float>(flow.water[from]);
    return static_cast<Quanta>(static_cast<float>(flow.sediment[from]) * (share * guard));
  }
  /// Sediment [quanta] that cell i loses through a face, negative if it gains.
  DESERT_HD Quanta sediment_loss(int i, int j, float out) const {
    const Quanta water = flow.through(i, j, out);
    return water > 0 ? sediment_with(i, water) : (water < 0 ? -sediment_with(j, -water) : 0);
  }
  DESERT_HD void operator()(int x, int y) const {
    const int i = flow.grid.index(x, y);
    const typename Flow<inside>::Faces f = flow.faces(x, y);
    const Quanta e = sediment_loss(i, f.east, f.to_east), w = sediment_loss(i, f.west, f.to_west);
    const Quanta n = sediment_loss(i, f.north, f.to_north), s = sediment_loss(i, f.south, f.to_south);
    flow.sediment_next[i] = flow.sediment[i] - ((e + w) + (n + s));
    if (inside) return;
    const Quanta over =
        (f.east < 0 ? e : 0) + (f.west < 0 ? w : 0) + (f.north < 0 ? n : 0) + (f.south < 0 ? s : 0);
    ledger.book_out(Material::sediment, i, over);
  }
};

}  // namespace desert_sim::virtual_pipes
