#pragma once
/// Water in the ground, of its upper metre. Nilles 2025 §3.4.4–3.4.5; physics.md C4.
///
///   capacity   C = c_M min(e + s, 1 m)
///   rate       r = lerp(r_soil, r_sand, min(s, 1 m))
///   seepage    M += min(r Δt (C − M), w), where M > C/2 · `when_wet`; what is over C comes out again
///   diffusion  M_i −= D Δt/l² min(C_i, C_j)(m_i − m_j), m = M/C: what is equally wet is at rest
///   drying     M ← M e^(−φ r (1 − ¾ v) Δt), at least one quantum, where no water stands
///
/// Published: diffusion of M itself, which would lift water into ground that has no room. On ground of one
/// depth they are the same. Diffusion is divided so that D Δt/l² ≤ ¼. Reads soil, sand, water, moisture,
/// vegetation; writes water, moisture.

#include "kernels/backend/for_each.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/field/math.hpp"
#include "src/core/parameters.hpp"

namespace desert_sim {

struct MoistureParameters {
  bool enabled = false;
  float seepage_soil = 0.02f;
  float seepage_sand = 0.1f;
  float when_wet = 0.02f;
  float diffusion = 0.05f;
  float evaporation = 0.05f;
};

constexpr auto parameter_table(const MoistureParameters*) {
  using P = MoistureParameters;
  return std::make_tuple(
      parameter("enabled", &P::enabled, "Whether water seeps into the ground, and dries out of it."),
      parameter("seepage_soil", &P::seepage_soil, 0, 10, "1/s",
                "How fast soil fills up, as a share of the room that is left (r_soil)."),
      parameter("seepage_sand", &P::seepage_sand, 0, 10, "1/s", "How fast sand does (r_sand)."),
      parameter("when_wet", &P::when_wet, 0, 1, "1",
                "What is left of that speed in ground that is more than half full."),
      parameter("diffusion", &P::diffusion, 0, 1e4, "m^2/s",
                "How fast moisture spreads through the ground (D)."),
      parameter("evaporation", &P::evaporation, 0, 100, "1",
                "How fast bare ground dries, in parts of the speed at which it fills up (phi)."));
}
static_assert(table_is_complete<MoistureParameters>());

namespace moisture {

/// The ground's room and speed.
struct Ground {
  const Quanta *soil, *sand;
  float capacity, quantum, quanta_per_metre;
  MoistureParameters p;

  /// Quanta that the ground can hold.
  DESERT_HD Quanta room(int i) const {
    const float depth = static_cast<float>(value_or_zero(soil, i) + sand[i]) * quantum;
    return static_cast<Quanta>(capacity * minimum(depth, 1.0f) * quanta_per_metre);
  }
  DESERT_HD float rate(int i) const {
    return lerp(p.seepage_soil, p.seepage_sand, minimum(sand[i] * quantum, 1.0f));
  }
};

/// `part` of `from`, at least one quantum, if there is any.
DESERT_HD Quanta some_of(Quanta from, float part) {
  if (from <= 0 || !(part > 0.0f)) return 0;
  const Quanta taken = static_cast<Quanta>(rintf(part * static_cast<float>(from)));
  return taken < 1 ? 1 : (taken > from ? from : taken);
}

/// Water into the ground, or out of it where it is too full; then dries what no water covers.
struct SeepAndDry {
  Grid grid;
  Ground ground;
  float time_step;
  const float* vegetation;
  Quanta *water, *moisture;
  LedgerView ledger;

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const Quanta room = ground.room(i), full = moisture[i], there = water[i];
    const float rate = ground.rate(i);
    Quanta in = room - full;  // what is too much comes out
    if (in > 0) {
      const float part =
          rate * time_step * (2 * static_cast<long long>(full) > room ? ground.p.when_wet : 1.0f);
      const Quanta wanted = some_of(in, minimum(part, 1.0f));
      in = wanted < there ? wanted : there;
      ledger.convert(Material::water, Material::moisture, i, in);
    } else {
      ledger.convert(Material::moisture, Material::water, i, -in);
    }
    const Quanta wet = full + in;
    water[i] = there - in;
    Quanta dried = 0;
    if (!((there - in) * ground.quantum > wet_depth)) {
      const float speed = ground.p.evaporation * rate * (1.0f - 0.75f * value_or_zero(vegetation, i));
      dried = some_of(wet, 1.0f - exp_negative(speed * time_step));
      ledger.book_out(Material::moisture, i, dried);
    }
    moisture[i] = wet - dried;
  }
};

/// What cells get from those beside them.
struct Spread {
  Grid grid;
  Ground ground;
  float number;  ///< D Δt/l² ≤ ¼
  const Quanta* moisture;
  Quanta* gain;

  DESERT_HD Quanta from(Quanta room, float wet, int x, int y) const {
    const int j = neighbour_index(grid, x, y);
    if (j < 0) return 0;
    const Quanta there = ground.room(j);
    if (there <= 0 || room <= 0) return 0;
    const float other = static_cast<float>(moisture[j]) / static_cast<float>(there);
    constexpr float guard = 1.0f - 1.0f / 1048576.0f;  // four parts of a quarter round
    return static_cast<Quanta>(number * guard * static_cast<float>(room < there ? room : there) *
                               (other - wet));
  }
  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const Quanta room = ground.room(i);
    const float wet = room > 0 ? static_cast<float>(moisture[i]) / static_cast<float>(room) : 0.0f;
    gain[i] = (from(room, wet, x + 1, y) + from(room, wet, x - 1, y)) +
              (from(room, wet, x, y + 1) + from(room, wet, x, y - 1));
  }
};
struct ApplySpread {
  Grid grid;
  const Quanta* gain;
  Quanta* moisture;
  DESERT_HD void operator()(int x, int y) const { moisture[grid.index(x, y)] += gain[grid.index(x, y)]; }
};

/// `capacity`: c_M; `gain`: scratch of one value a cell.
template <class E>
void step(E& exec, const TerrainView& t, const MoistureParameters& p, float capacity, float time_step,
          LedgerView ledger, Quanta* gain) {
  const Ground ground{
      t.quanta(Layer::soil), t.quanta(Layer::sand), capacity, t.quantum, t.quanta_per_metre, p};
  Quanta *water = t.quanta(Layer::water), *moisture = t.quanta(Layer::moisture);
  for_each_cell(exec, t.grid,
                SeepAndDry{t.grid, ground, time_step, t.real(Layer::vegetation), water, moisture, ledger});
  const float number = p.diffusion * time_step / (t.grid.cell_size * t.grid.cell_size);
  if (!(number > 0.0f)) return;
  const int parts = static_cast<int>(std::ceil(number * 4.0f));
  for (int n = 0; n < parts; ++n) {
    for_each_cell(exec, t.grid, Spread{t.grid, ground, number / static_cast<float>(parts), moisture, gain});
    for_each_cell(exec, t.grid, ApplySpread{t.grid, gain, moisture});
  }
}

}  // namespace moisture
}  // namespace desert_sim
