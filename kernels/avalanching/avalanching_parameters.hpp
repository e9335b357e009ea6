#pragma once
/// Parameters of avalanching; avalanching.hpp explains the schemes.

#include "src/core/parameter_table.hpp"

namespace desert_sim {

enum class AvalancheScheme : int { multilevel, gradient, sweeps, taylor_keyser };
constexpr const char* avalanche_schemes[] = {"multilevel", "gradient", "sweeps", "taylor_keyser"};
/// Whether a scheme is a multigrid cycle, in place of sweeps over the whole grid.
constexpr bool has_levels(AvalancheScheme s) {
  return s == AvalancheScheme::multilevel || s == AvalancheScheme::gradient;
}
enum class AvalancheQuality : int { fast, good, converged };
constexpr const char* avalanche_qualities[] = {"fast", "good", "converged"};

struct AvalanchingParameters {
  bool enabled = true;
  AvalancheScheme scheme = AvalancheScheme::gradient;
  AvalancheQuality quality = AvalancheQuality::good;
  float transfer = 1.0f;
  float low_transfer = 0.0f;
  int low_every = 10;
  int low_last = 5;
  float taylor_keyser_transfer = 0.25f;
  float coarsest_cell = 0.0f;
  int last_passes = 0;
  int sweeps = 50;
  float tolerance = 0.001f;
  int max_iterations = 20000;
  bool soil = true;
  bool bedrock = true;
  bool bedrock_to_sand = true;
};

constexpr auto parameter_table(const AvalanchingParameters*) {
  using P = AvalanchingParameters;
  return std::make_tuple(
      parameter("enabled", &P::enabled, "Whether steep sand slides."),
      parameter("scheme", &P::scheme, avalanche_schemes,
                "How slides are computed: by the gradient, alike in every direction, or by eight neighbours "
                "(multilevel; sweeps and taylor_keyser for comparison)."),
      parameter("quality", &P::quality, avalanche_qualities,
                "fast: few sweeps, good: more, and most of all on small grids; both more where much slides; "
                "converged: until tolerance (also for sweeps)."),
      parameter("transfer", &P::transfer, 0.05, 1, "1",
                "Share of what would stabilise a cell that one sweep moves (k_c)."),
      parameter(
          "low_transfer", &P::low_transfer, 0, 1, "1",
          "Likewise of some sweeps of the schemes sweeps and taylor_keyser, against artefacts (Nilles 2024, "
          "figure 9: 0.5 beside 1); 0: none."),
      parameter("low_every", &P::low_every, 0, 1000, "1",
                "low_transfer is that of every so many sweeps; 0: of none."),
      parameter("low_last", &P::low_last, 0, 1000, "1", "And of so many sweeps at the end of a step."),
      parameter(
          "taylor_keyser_transfer", &P::taylor_keyser_transfer, 0.01, 1, "1",
          "Share of the largest drop that a sweep of taylor_keyser moves where transfer is 1 (k_c: 0.25 in "
          "Taylor & Keyser 2023, 0.25 and 0.5 in Nilles 2024)."),
      parameter("coarsest_cell", &P::coarsest_cell, 0, 1000, "m",
                "Width of cells at which coarsening stops; 0: four cells of the grid."),
      parameter("last_passes", &P::last_passes, 0, 16, "1",
                "Passes over the fine grid after the coarse levels, each with the sweeps of large "
                "grids; 0: by quality and grid."),
      parameter("sweeps", &P::sweeps, 1, 1000, "1",
                "Sweeps a step of the schemes sweeps and taylor_keyser, unless converged."),
      parameter("tolerance", &P::tolerance, 1e-6, 1, "1",
                "Largest excess that counts as converged, in cell sizes; multilevel gets to 2e-4."),
      parameter("max_iterations", &P::max_iterations, 1, 20000, "1",
                "Most fine sweeps a step when converging."),
      parameter("soil", &P::soil, "Whether steep soil slides, where it changed."),
      parameter("bedrock", &P::bedrock, "Whether steep bedrock breaks, where it changed."),
      parameter("bedrock_to_sand", &P::bedrock_to_sand, "Whether broken bedrock turns to sand."));
}
static_assert(table_is_complete<AvalanchingParameters>());

}  // namespace desert_sim
