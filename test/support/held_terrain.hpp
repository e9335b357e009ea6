#pragma once
/// A layer whose changes are told to somebody, and the same cell by cell, as a reference.

#include <vector>

#include "src/simulation/simulation.hpp"
#include "src/terrain/terrain.hpp"

namespace desert_sim::test {

/// Values that a test chooses: of the elevation, between 0 and 300 m, which is that of bare rock; or of
/// another layer.
class HeldTerrain {
 public:
  HeldTerrain(Exec& exec, int width, int height, Layer layer = Layer::elevation);
  /// In the layer's unit; heights and depths are rounded to quanta.
  void set(const std::vector<float>& values);
  std::vector<float> values() const { return terrain_.values(stored()); }
  void hold();
  std::vector<TileChange> take(const held_layer::Tolerance& tolerance, int tile);
  std::vector<float> held() const { return held_.download(); }

 private:
  Layer stored() const { return layer_ == Layer::elevation ? Layer::bedrock : layer_; }

  Exec& exec_;
  const Layer layer_;
  Terrain terrain_;
  Buffer<float> held_;
  Staging staging_;
};

/// Lets the simulation hold the present values of a layer for subscribers.
void hold(Simulation& simulation, Layer layer = Layer::elevation);
/// Starts a copy of what changed since; empty if nothing is held.
Pending<LayerChanges> begin_changes(Simulation& simulation, float threshold, int tile,
                                    Layer layer = Layer::elevation);

/// What updates are to say, with plain arithmetic: the cells of `now` that changed from `held`, which then
/// holds them.
std::vector<TileChange> expected_changes(const std::vector<float>& now, std::vector<float>& held, int width,
                                         const held_layer::Tolerance& tolerance, int tile);

/// Whether these are the same floats, bit by bit: NaN is NaN.
bool same_bits(const std::vector<float>& a, const std::vector<float>& b);

/// Expects the same tiles, to the bit.
void expect_same(const std::vector<TileChange>& found, const std::vector<TileChange>& expected);

}  // namespace desert_sim::test
