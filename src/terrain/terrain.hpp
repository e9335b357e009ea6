#pragma once
/// The terrain: its grid, its height scale, and its layers in the memory of the backend's device.

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "kernels/backend/buffer.hpp"
#include "kernels/view/layer_values.hpp"

namespace desert_sim {

/// The layer with this name. Throws ConfigError that lists the known names.
Layer layer_by_name(const std::string& name);

/// How heights are stored as integers (quanta): value [m] = datum + quanta · 2^exponent for elevations, and
/// quanta · 2^exponent for depths.
struct HeightScale {
  /// With the coarsest, load_limit is 2²¹ m: more than half the relief of bedrock, soil and sand that are
  /// any_height high or deep.
  static constexpr int finest = -20, coarsest = -8;
  double datum = 0;       ///< [m]
  int exponent = finest;  ///< quantum = 2^exponent m

  double quantum() const { return std::ldexp(1.0, exponent); }
  /// The finest scale (not below 2⁻²⁰ m) that can represent heights from `lowest` to `highest` [m] with
  /// headroom for moving sand.
  static HeightScale covering(double lowest, double highest);
  /// Whether the layer's values are elevations, which count from the datum.
  bool is_elevation(Layer layer) const {
    return layer == Layer::bedrock || layer == Layer::elevation || layer == Layer::water_surface;
  }
};

class Terrain {
 public:
  /// Sets all cells of all layers to 0 (the bedrock to the datum). Throws ConfigError if the grid has more
  /// than max_grid_cells, or if memory runs out; require_memory() in src/simulation/memory/memory.hpp
  /// checks the memory beforehand.
  Terrain(Exec& exec, const Grid& grid, const HeightScale& scale);

  Exec& exec() const { return *exec_; }
  const Grid& grid() const { return grid_; }
  const HeightScale& scale() const { return scale_; }
  bool has(Layer layer) const { return static_cast<bool>(layers_[static_cast<std::size_t>(layer)]); }
  /// Allocates the layer and fills it with 0, unless it is allocated already.
  void allocate(Layer layer);
  /// Allocates a derived layer as require() does, or frees it.
  void set_allocated(Layer layer, bool wanted);
  TerrainView view() const;

  /// Values in the layer's unit (bedrock and elevation absolute), row-major from the south-west; all 0 if the
  /// layer is not allocated.
  std::vector<float> values(Layer layer) const;
  /// The conversion of a layer's quanta to metres.
  QuantaToMetres metres(Layer layer) const;
  /// Sets a layer, rounding to quanta. `values` must have one value per cell, within the layer's range; the
  /// caller checks that.
  void set_values(Layer layer, const std::vector<double>& values);

  /// The layer's words as stored, for checkpoints and state hashes.
  std::vector<std::uint32_t> raw_words(Layer layer) const;
  void set_raw_words(Layer layer, const std::vector<std::uint32_t>& raw_words);
  std::uint32_t* data(Layer layer) const { return layers_[static_cast<std::size_t>(layer)].data(); }
  /// Memory of all layers [bytes].
  std::size_t bytes() const;

 private:
  Exec* exec_;
  Grid grid_;
  HeightScale scale_;
  std::array<Buffer<std::uint32_t>, layer_count> layers_;
};

}  // namespace desert_sim
