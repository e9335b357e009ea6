#pragma once
/// A surface whose changes are told to somebody, and the same cell by cell, as a reference.

#include <vector>

#include "src/simulation/views/elevation_changes.hpp"
#include "src/terrain/terrain.hpp"

namespace desert_sim::test {

/// Heights that a test chooses, between 0 and 300 m: of bare rock.
class HeldTerrain {
 public:
  HeldTerrain(Exec& exec, int width, int height);
  /// In metres; rounded to quanta.
  void set(const std::vector<float>& elevation);
  std::vector<float> elevation() const { return terrain_.values(Layer::bedrock); }
  void hold();
  std::vector<TileChange> take(float threshold, int tile);
  std::vector<float> held() const { return held_.download(); }

 private:
  Exec& exec_;
  Terrain terrain_;
  Buffer<float> held_;
  Staging staging_;
};

/// What updates are to say, with plain arithmetic: the cells of `now` that differ from `held` by more than
/// the threshold, which then holds them.
std::vector<TileChange> expected_changes(const std::vector<float>& now, std::vector<float>& held, int width,
                                         float threshold, int tile);

/// Expects the same tiles, to the bit.
void expect_same(const std::vector<TileChange>& found, const std::vector<TileChange>& expected);

}  // namespace desert_sim::test
