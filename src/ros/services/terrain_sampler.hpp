#pragma once
/// Samples of the terrain at points, for ~query_terrain: bilinear between cell centres, and constant beyond
/// the outermost centres.

#include <desert_sim/TerrainSample.h>

#include <vector>

#include "src/simulation/simulation.hpp"

namespace desert_sim {

/// The layers that TerrainSampler reads.
const std::vector<Layer>& sampled_layers();

class TerrainSampler {
 public:
  /// Keeps a reference to the snapshot.
  explicit TerrainSampler(const Snapshot& snapshot);
  /// The sample at (x, y) in the terrain's frame [m]; outside the terrain all values are NaN.
  TerrainSample at(double x, double y) const;

 private:
  /// The indices of the four cells whose centres surround a point, and the point's place between them, 0…1.
  struct CellQuad {
    std::size_t i00, i10, i01, i11;
    double fx, fy;
  };
  CellQuad cells_around(double x, double y) const;
  static double value(const std::vector<float>* layer, const CellQuad& p);

  const Snapshot& s_;
  const std::vector<float>*elevation_, *bedrock_, *sand_, *soil_, *water_, *moisture_, *vegetation_, *wind_x_,
      *wind_y_;
};

}  // namespace desert_sim
