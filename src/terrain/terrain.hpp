#pragma once
/// The terrain: its grid, where it lies, and its layers on the backend's device.

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "kernels/backend/buffer.hpp"
#include "kernels/view/layer_values.hpp"

namespace desert_sim {

/// Layer by name; throws ConfigError that lists the known ones.
Layer layer_by_name(const std::string& name);

/// How heights are counted: value [m] = datum + quanta · 2^exponent for elevations, quanta · 2^exponent for
/// depths.
struct HeightScale {
  double datum = 0;    ///< [m]
  int exponent = -20;  ///< quantum = 2^exponent m

  double quantum() const { return std::ldexp(1.0, exponent); }
  /// The finest scale (not below 2⁻²⁰ m) that holds heights from `lowest` to `highest` with room for moving
  /// sand.
  static HeightScale covering(double lowest, double highest);
  bool absolute(Layer layer) const {
    return layer == Layer::bedrock || layer == Layer::elevation || layer == Layer::water_surface;
  }
};

class Terrain {
 public:
  /// All cells of all layers are 0 (bedrock: the datum). Throws ConfigError if there are more than
  /// most_cells, or if memory runs out; whether it will, require_memory() of simulation/memory.hpp tells
  /// before.
  Terrain(Exec& exec, const Grid& grid, const HeightScale& scale);

  Exec& exec() const { return *exec_; }
  const Grid& grid() const { return grid_; }
  const HeightScale& scale() const { return scale_; }
  bool has(Layer layer) const { return static_cast<bool>(layers_[static_cast<std::size_t>(layer)]); }
  /// Takes the layer into use, all 0, if it is not yet.
  void require(Layer layer);
  /// Takes a derived layer into use, or out of it.
  void use(Layer layer, bool wanted);
  TerrainView view() const;

  /// Values in the layer's unit (bedrock and elevation absolute), row-major from the south-west; 0 if not in
  /// use.
  std::vector<float> values(Layer layer) const;
  /// What a number of quanta in a layer stands for.
  Metres metres(Layer layer) const;
  /// Rounds to quanta. `values` must have one per cell, within the layer's range (checked by the caller).
  void set_values(Layer layer, const std::vector<double>& values);

  /// Bits as stored, for checkpoint and hash.
  std::vector<std::uint32_t> words(Layer layer) const;
  void set_words(Layer layer, const std::vector<std::uint32_t>& words);
  std::uint32_t* data(Layer layer) const { return layers_[static_cast<std::size_t>(layer)].data(); }
  /// Bytes of all layers.
  std::size_t bytes() const;

 private:
  Exec* exec_;
  Grid grid_;
  HeightScale scale_;
  std::array<Buffer<std::uint32_t>, layer_count> layers_;
};

}  // namespace desert_sim
