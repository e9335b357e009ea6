#include "src/terrain/terrain.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "src/core/did_you_mean.hpp"
#include "src/core/error.hpp"
#include "src/core/joined.hpp"

namespace desert_sim {

Layer layer_by_name(const std::string& name) {
  for (const LayerInfo& layer : layer_table)
    if (name == layer.name) return layer.layer;
  throw ConfigError("layer " +
                    not_one_of(name, joined(layer_table, [](const LayerInfo& l) { return l.name; })));
}

HeightScale HeightScale::covering(double lowest, double highest) {
  HeightScale scale;
  scale.datum = std::round(0.5 * (lowest + highest));
  const double reach = std::max(highest - scale.datum, scale.datum - lowest);
  while (reach >= std::ldexp(static_cast<double>(load_limit), scale.exponent)) ++scale.exponent;
  return scale;
}

Terrain::Terrain(Exec& exec, const Grid& grid, const HeightScale& scale)
    : exec_(&exec), grid_(grid), scale_(scale) {
  const long long cells = static_cast<long long>(grid.width) * grid.height;
  if (cells > max_grid_cells)
    throw ConfigError("grid of " + std::to_string(grid.width) + " x " + std::to_string(grid.height) +
                      " has " + std::to_string(cells) + " cells (allowed: at most " +
                      std::to_string(max_grid_cells) + ")");
  for (Layer layer :
       {Layer::bedrock, Layer::sand, Layer::airborne_sand, Layer::elevation, Layer::wind_x, Layer::wind_y})
    allocate(layer);
}

void Terrain::allocate(Layer layer) {
  auto& buffer = layers_[static_cast<std::size_t>(layer)];
  if (buffer) return;
  buffer = Buffer<std::uint32_t>(*exec_, static_cast<std::size_t>(grid_.cells()));
  buffer.set_zero();
}

void Terrain::set_allocated(Layer layer, bool wanted) {
  if (wanted) return allocate(layer);
  layers_[static_cast<std::size_t>(layer)] = {};
}

TerrainView Terrain::view() const {
  TerrainView v;
  v.grid = grid_;
  v.quantum = static_cast<float>(scale_.quantum());
  v.quanta_per_metre = 1.0f / v.quantum;
  for (std::size_t n = 0; n < layers_.size(); ++n) v.layers[n] = layers_[n].data();
  return v;
}

std::vector<std::uint32_t> Terrain::raw_words(Layer layer) const {
  return layers_[static_cast<std::size_t>(layer)].download();
}

void Terrain::set_raw_words(Layer layer, const std::vector<std::uint32_t>& raw_words) {
  allocate(layer);
  layers_[static_cast<std::size_t>(layer)].upload(raw_words);
}

QuantaToMetres Terrain::metres(Layer layer) const {
  return {scale_.quantum(), scale_.is_elevation(layer) ? scale_.datum : 0.0};
}

std::vector<float> Terrain::values(Layer layer) const {
  std::vector<float> values(static_cast<std::size_t>(grid_.cells()), 0.0f);
  if (!has(layer)) return values;
  const std::vector<std::uint32_t> stored = raw_words(layer);
  if (info(layer).storage == Storage::real) {
    std::memcpy(values.data(), stored.data(), stored.size() * sizeof(float));
    return values;
  }
  std::transform(stored.begin(), stored.end(), values.begin(),
                 [metres = metres(layer)](std::uint32_t word) { return metres(static_cast<Quanta>(word)); });
  return values;
}

void Terrain::set_values(Layer layer, const std::vector<double>& values) {
  std::vector<std::uint32_t> raw_words(values.size());
  if (info(layer).storage == Storage::real) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const float value = static_cast<float>(values[i]);
      std::memcpy(&raw_words[i], &value, sizeof value);
    }
  } else {
    const double per_metre = 1.0 / scale_.quantum(), datum = scale_.is_elevation(layer) ? scale_.datum : 0.0;
    for (std::size_t i = 0; i < values.size(); ++i)
      raw_words[i] =
          static_cast<std::uint32_t>(static_cast<Quanta>(std::llround((values[i] - datum) * per_metre)));
  }
  set_raw_words(layer, raw_words);
}

std::size_t Terrain::bytes() const {
  std::size_t total = 0;
  for (const auto& buffer : layers_) total += buffer.size() * sizeof(std::uint32_t);
  return total;
}

}  // namespace desert_sim
