/// Laws and steps of soil_and_bedrock.hpp; compiled once for each backend.
#include "kernels/avalanching/soil_and_bedrock.hpp"

#include "kernels/avalanching/avalanching.hpp"
#include "kernels/avalanching/laws.hpp"
#include "kernels/backend/loops.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/sand/repose.hpp"

namespace desert_sim::avalanching {

/// Soil as the mobile layer of a level whose ground is the bedrock, with its own angle of repose. Has the
/// interface of LevelView.
struct SoilLevel {
  struct Angle {
    float bare, vegetated;  ///< tangents
    const float* vegetation;
    repose::RelativeMoisture moisture;
    repose::MoistureFactor moisture_factor;
    DESERT_HD float operator[](int i) const {
      const float dry = lerp(bare, vegetated, value_or_zero(vegetation, i));
      return dry * moisture_factor(moisture(i));
    }
  };

  Grid grid;
  const Quanta *bedrock, *sand;  ///< `sand` is what slides on any level: here it is soil
  const float* obstacle;         ///< or null
  Angle repose;
  float quanta_per_cell;

  DESERT_HD bool wall(int i) const { return bedrock[i] >= wall_height || value_or_zero(obstacle, i) > 0.0f; }
  DESERT_HD Quanta height(int i) const { return wall(i) ? wall_height : bedrock[i] + sand[i]; }
};

/// Bedrock as a level that is mobile down to the lowest possible ground, with one angle of repose everywhere.
struct RockLevel {
  static constexpr Quanta lowest_ground = 1 - wall_height;
  struct Column {
    const Quanta* bedrock;
    DESERT_HD Quanta operator[](int i) const { return bedrock[i] - lowest_ground; }
  };
  struct UniformRepose {
    float tangent;
    DESERT_HD float operator[](int) const { return tangent; }
  };

  Grid grid;
  Column sand;
  const float* obstacle;  ///< or null
  UniformRepose repose;
  float quanta_per_cell;

  DESERT_HD bool wall(int i) const { return value_or_zero(obstacle, i) > 0.0f; }
  DESERT_HD Quanta height(int i) const { return wall(i) ? wall_height : sand.bedrock[i]; }
};

struct ApplyRockfall {
  Grid grid;
  const Quanta *given, *received;
  bool to_sand;
  Quanta *bedrock, *sand;
  LedgerView ledger;
  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    if (given[i] == 0 && received[i] == 0) return;
    bedrock[i] -= given[i];
    (to_sand ? sand : bedrock)[i] += received[i];
    if (to_sand) {
      ledger.book_out(Material::bedrock, i, given[i]);
      ledger.book_in(Material::sand, i, received[i]);
    }
  }
};

template <class E>
void step_soil(E& exec, const TerrainView& t, const AvalanchingParameters& p, const ReposeParameters& repose,
               Quanta* given, GroundWorkspace& work) {
  const repose::Tangents tangents(repose);
  const SoilLevel level{t.grid,
                        t.quanta(Layer::bedrock),
                        t.quanta(Layer::soil),
                        t.real(Layer::obstacle),
                        {tangents.soil, tangents.soil_vegetated, t.real(Layer::vegetation),
                         repose::RelativeMoisture(t, repose), tangents.moisture_factor},
                        t.grid.cell_size * t.quanta_per_metre};
  give_and_receive(exec, level, p.transfer, false, work.share.data(), given, work.received.data());
  for_each_cell(exec, t.grid, ApplySweep{t.grid, given, work.received.data(), t.quanta(Layer::soil)});
}

template <class E>
void step_bedrock(E& exec, const TerrainView& t, const AvalanchingParameters& p,
                  const ReposeParameters& repose, LedgerView ledger, Quanta* given, GroundWorkspace& work) {
  const RockLevel level{t.grid,
                        {t.quanta(Layer::bedrock)},
                        t.real(Layer::obstacle),
                        {repose::Tangents(repose).bedrock},
                        t.grid.cell_size * t.quanta_per_metre};
  give_and_receive(exec, level, p.transfer, false, work.share.data(), given, work.received.data());
  for_each_cell(exec, t.grid,
                ApplyRockfall{t.grid, given, work.received.data(), p.bedrock_to_sand,
                              t.quanta(Layer::bedrock), t.quanta(Layer::sand), ledger});
}

template void step_soil(Backend&, const TerrainView&, const AvalanchingParameters&, const ReposeParameters&,
                        Quanta*, GroundWorkspace&);
template void step_bedrock(Backend&, const TerrainView&, const AvalanchingParameters&,
                           const ReposeParameters&, LedgerView, Quanta*, GroundWorkspace&);

}  // namespace desert_sim::avalanching
