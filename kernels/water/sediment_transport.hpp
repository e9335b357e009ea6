#pragma once
/// Transport of suspended sediment through the faces between cells (donor-cell scheme): a cell that gives a
/// share of its water gives the same share of its sediment.
///
///   S_i += Σ_in S_j q_j/w_j − Σ_out S_i q_i/w_i
///
/// q is the depth of water that passes a face in a sub-step, before it is rounded to quanta; S is rounded as
/// water is. So sediment comes only to where water comes. The
/// published method (Nilles 2025 §3.4.1) moves it by U Δt, which lands on dry ground beside a stream that is
/// fast or bends, and builds ridges one cell wide there.

#include "kernels/field/ledger.hpp"
#include "kernels/water/face_flow.hpp"

namespace desert_sim::face_flow {

template <bool inside>
struct CarrySediment {
  Flow<inside> flow;
  LedgerView ledger;

  Die die_x, die_y;

  DESERT_HD void operator()(int x, int y) const {
    const int i = flow.grid.index(x, y);
    const typename Flow<inside>::Faces f = flow.shared(x, y, flow.sediment_share);
    const Quanta e = die_x.whole(f.to_east, i), w = die_x.whole(f.to_west, flow.face_to(i, f.west));
    const Quanta n = die_y.whole(f.to_north, i), s = die_y.whole(f.to_south, flow.face_to(i, f.south));
    flow.sediment_next[i] = flow.sediment[i] - ((e + w) + (n + s));
    if (inside) return;
    const Quanta over =
        (f.east < 0 ? e : 0) + (f.west < 0 ? w : 0) + (f.north < 0 ? n : 0) + (f.south < 0 ? s : 0);
    ledger.book_out(Material::sediment, i, over);
  }
};

}  // namespace desert_sim::face_flow
