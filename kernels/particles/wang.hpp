#pragma once
/// Wind ripples of flying grains, on cells of about a centimetre: the particle model of Wang & Hu 2012. It
/// takes the place of saltation and reptation; what is too steep afterwards slides (avalanching.hpp).
///
/// In each step every cell gives a packet of sand to the wind, which flies as a grain of diameter d:
///
///   lift-off   V_z = B u,  B in [0.8, 2] and the angle in [21°, 90°] by dice, along the wind's direction
///   flight     dV/dt = ¾ C_d ρ_a/(ρ_s d) |U − V| (U − V) − g
///   wind       U = u_*t/κ ln(z'/z_0)                           z' = z − z_d < z_f;  0 for z' < z_0 = d/n_0
///              U = u_*t/κ ln(z_f/z_0) + u_*/κ ln(z'/z_f)       above;   n_0 = `grains_per_roughness`
///   bounce     V_2 = −e_n V_1n + e_t V_1t     normal and tangential part of the velocity V_1
///   rest       where the speed away from the bed would be less than √(2 g d), which lifts a grain by d, or
///              after `most_bounces`
///
/// The model as published lets grains bounce for ever, and its ripples move against the wind. Five things put
/// that right, and end their growth.
///
/// Shelter. The plane of zero wind z_d, which the model leaves at the ground, is raised in the lee of crests:
/// it falls from each crest by the angle `shelter_deg` down to the ground. Grains that fly over a crest lose
/// their drive and come down behind it, and none is lifted there.
///
/// Slow wind near the ground. Below the focus z_f flying grains hold the wind at the threshold u_*t (Bagnold
/// 1941, Owen 1964).
///
/// Rest by the normal speed. A grain that skims the ground keeps its speed, but each bounce takes the share
/// 1 − e_n of the speed with which it rises: on level ground there are at most ln(V_z/√(2 g d))/ln(1/e_n).
///
/// Splash. Each impact at speed v throws up a_s v/√(g d) grains, at a speed with the mean
///
///   v_e = α √(g d)/a_s (1 − exp(−v/(n_s √(g d))))    exponentially distributed, at most v
///
/// (Kok & Renno 2009; a_s = `splash_number`, α = `splash_momentum`, n_s = `splash_speed`), which hop once.
/// On a slope that faces them more grains fall, and throw sand a hop further, to the crest. That lets
/// ripples grow, and go with the wind (Anderson 1987). With a splash of the depth S sand creeps downhill,
/// too: −λ_c S ∇h to the four neighbours, λ_c = `creep_length`.
///
/// The rate of lift-off is what keeps the flow of grains in balance with the wind (Owen 1964): grains that
/// gain the speed Δv on the way from lift-off to rest take up the stress above the threshold,
///
///   E = ρ_a (u² − u_*t²)₊ / (φ ρ_s Δv) · (1 + cot α ∂h/∂s)₊    depth of bed in a second [m/s]
///   u_*t = a √((ρ_s/ρ_a − 1) g d)
///
/// where u is the shear velocity at the cell. The shelter lessens it by the factor by which it lessens the
/// wind `shear_height` grains above the bed. Crests stand in faster wind, which ends their growth (Bagnold
/// 1941): it rises by the factor ln((z_e + h − h_u)/z_0)/ln(z_e/z_0) with h_u the mean ground upwind,
/// weighted by exp(−distance/ℓ), z_e = `exposed_height`, ℓ = `upwind_length`. The last factor of E counts
/// the impacts on a slope along the wind, because in steady transport a grain that comes to rest is
/// replaced by one that impacts set free; Δv and the angle of impact α are means over level ground. Plants
/// and moisture lessen E by the factors 1 − v and M of saltation.hpp, and the splash likewise; none is
/// lifted under water.
///
/// The undisturbed wind blows everywhere in the same direction. Grains come to rest on sand, soil or rock,
/// but not on obstacles: what would rest there lies where it last was over other ground. Over an open edge
/// grains leave, and `saltation.influx` brings others.
///
/// Packets are whole quanta. Cells take them from their own sand and add them to that of others, so that
/// neither threads nor backends change a bit.
///
/// Reads bedrock, soil, sand, obstacle, vegetation, moisture, water; writes sand, the undisturbed wind to
/// wind_x and wind_y, and the impact strength, which is the depth of sand that came down.

#include "kernels/backend/buffer.hpp"
#include "kernels/field/dice.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/particles/flight.hpp"
#include "kernels/particles/particle_parameters.hpp"
#include "kernels/sand/repose.hpp"
#include "kernels/sand/saltation.hpp"
#include "kernels/wind/vector.hpp"

namespace desert_sim::particles {

/// Heights at a cell [quanta].
struct Column {
  Quanta surface, shelter;  ///< the shelter's is that of the surface where there is none
  Quanta upwind;            ///< mean of the surface upwind, weighted by exp(−distance/ℓ)
};

struct Workspace {
  Buffer<Column> columns;  ///< in the order of a sweep downwind
  Buffer<Quanta> lines;    ///< of the sweep
  Buffer<Quanta> impacts;  ///< what fell on a cell [quanta]
  Buffer<Quanta> splash;   ///< what that throws up where there is enough sand [quanta]
  Buffer<Quanta> landed;   ///< what came to rest [quanta]

  std::size_t bytes() const {
    return columns.bytes() + lines.bytes() + impacts.bytes() + splash.bytes() + landed.bytes();
  }
};

Workspace make_workspace(Exec& exec, const Grid& grid);

/// What the parameters and the wind say, on the host.
struct Wind {
  Air air;
  float shear_velocity;  ///< u_* [m/s]
  float threshold;       ///< u_*t [m/s]
  float lift_rate;       ///< E of level ground [m/s]
  float exposure;  ///< cot α: mean over impacts of the ratio of the speeds along and into the ground [1]

  Wind(const ParticleParameters& p, wind::Vector above);
};

/// √(2 g d): the speed with which a grain rises by its own diameter [m/s].
float least_rise(const ParticleParameters& p);

/// The way of a grain over level ground, from lift-off to rest.
struct LevelRun {
  float first_hop;  ///< length [m]
  float gain;       ///< Δv: what the wind adds to the speed along it on all hops [m/s]
  float steepness;  ///< sum over the impacts of the ratio of the speeds along and into the ground
  int bounces;
};
LevelRun level_run(const ParticleParameters& p, const Air& air, float up, float forward);

/// Longest step [s], in which the wind lifts a hundredth of a cell's width off level ground. Infinity
/// where the wind lifts nothing.
float longest_step(const ParticleParameters& p, const Grid& grid, wind::Vector above);

struct StepInputs {
  ParticleParameters particle;
  ReposeParameters repose;        ///< for the ground's capacity of moisture
  SaltationParameters saltation;  ///< for the influx and the cut-off by moisture
  float time_step;                ///< [s]
  wind::Vector above;             ///< undisturbed wind [m/s]
  float* impact_strength;         ///< [m], or null
};

/// A place in flight: metres east and north of the terrain's south-west corner, and the height.
struct PathPoint {
  float x, y, z;
};

/// Ways of grains, in memory of the device.
struct GrainPaths {
  int number;         ///< of paths
  int most_points;    ///< of each; where a grain flies on, the last one is where it was last seen
  PathPoint* points;  ///< of path n from n · most_points on
  int* counts;        ///< of points of each path; 0 where the wind lifts nothing

  DESERT_HD PathPoint* path(int n) const { return points + static_cast<std::size_t>(n) * most_points; }
  /// Path n has so many points; the rest of its memory is 0.
  DESERT_HD void end(int n, int count) const {
    counts[n] = count;
    for (int k = count; k < most_points; ++k) path(n)[k] = {0.0f, 0.0f, 0.0f};
  }
  /// Where grain n starts: spread evenly over the terrain (R2 sequence).
  DESERT_HD int cell(int n, const Grid& grid) const {
    const double east = (n + 0.5) * 0.7548776662466927, north = (n + 0.5) * 0.5698402909980532;
    const int x = static_cast<int>((east - floor(east)) * grid.width),
              y = static_cast<int>((north - floor(north)) * grid.height);
    return grid.index(clamp_index(x, grid.width), clamp_index(y, grid.height));
  }
};

/// The ways of some of the grains that step() would lift with these inputs and dice, from lift-off to rest.
/// Moves nothing.
template <class E>
void trace(E& exec, const TerrainView& t, const StepInputs& in, const Dice& dice, Workspace& work,
           const GrainPaths& paths);

/// Writes wind_x and wind_y.
template <class E>
void blow(E& exec, const TerrainView& t, wind::Vector above);

template <class E>
void step(E& exec, const TerrainView& t, const StepInputs& in, const Dice& dice, LedgerView ledger,
          Workspace& work);

}  // namespace desert_sim::particles
