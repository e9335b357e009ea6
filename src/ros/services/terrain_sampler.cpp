#include "src/ros/services/terrain_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/core/elementary.hpp"

namespace desert_sim {

const std::vector<Layer>& sampled_layers() {
  static const std::vector<Layer> layers{Layer::elevation,  Layer::bedrock, Layer::sand,
                                         Layer::soil,       Layer::water,   Layer::moisture,
                                         Layer::vegetation, Layer::wind_x,  Layer::wind_y};
  return layers;
}

TerrainSampler::TerrainSampler(const Snapshot& snapshot)
    : s_(snapshot),
      elevation_(s_.find(Layer::elevation)),
      bedrock_(s_.find(Layer::bedrock)),
      sand_(s_.find(Layer::sand)),
      soil_(s_.find(Layer::soil)),
      water_(s_.find(Layer::water)),
      moisture_(s_.find(Layer::moisture)),
      vegetation_(s_.find(Layer::vegetation)),
      wind_x_(s_.find(Layer::wind_x)),
      wind_y_(s_.find(Layer::wind_y)) {}

TerrainSampler::CellQuad TerrainSampler::cells_around(double x, double y) const {
  const auto between = [](double cells, int n, int& first, int& second, double& share) {
    const double centre = std::clamp(cells - 0.5, 0.0, static_cast<double>(n - 1));
    first = std::min(static_cast<int>(centre), std::max(0, n - 2));
    second = std::min(first + 1, n - 1);
    share = centre - first;
  };
  int x0, x1, y0, y1;
  CellQuad p;
  between((x - s_.origin_x) / s_.cell_size, s_.width, x0, x1, p.fx);
  between((y - s_.origin_y) / s_.cell_size, s_.height, y0, y1, p.fy);
  const auto index = [this](int ix, int iy) { return static_cast<std::size_t>(iy) * s_.width + ix; };
  p.i00 = index(x0, y0);
  p.i10 = index(x1, y0);
  p.i01 = index(x0, y1);
  p.i11 = index(x1, y1);
  return p;
}

double TerrainSampler::value(const std::vector<float>* layer, const CellQuad& p) {
  if (!layer) return 0.0;
  const std::vector<float>& v = *layer;
  return (v[p.i00] * (1 - p.fx) + v[p.i10] * p.fx) * (1 - p.fy) +
         (v[p.i01] * (1 - p.fx) + v[p.i11] * p.fx) * p.fy;
}

TerrainSample TerrainSampler::at(double x, double y) const {
  TerrainSample sample;
  const double right = s_.origin_x + s_.width * s_.cell_size, top = s_.origin_y + s_.height * s_.cell_size;
  sample.in_bounds = x >= s_.origin_x && x <= right && y >= s_.origin_y && y <= top;
  sample.position.x = x;
  sample.position.y = y;
  if (!sample.in_bounds) {
    for (double* number :
         {&sample.position.z, &sample.elevation, &sample.normal.x, &sample.normal.y, &sample.normal.z,
          &sample.slope, &sample.sand, &sample.soil, &sample.water, &sample.moisture, &sample.vegetation,
          &sample.bedrock, &sample.wind.x, &sample.wind.y, &sample.wind.z})
      *number = std::numeric_limits<double>::quiet_NaN();
    return sample;
  }
  const CellQuad p = cells_around(x, y);
  sample.elevation = sample.position.z = value(elevation_, p);
  sample.sand = value(sand_, p);
  sample.soil = value(soil_, p);
  sample.water = value(water_, p);
  sample.moisture = value(moisture_, p);
  sample.vegetation = value(vegetation_, p);
  sample.bedrock = value(bedrock_, p);
  sample.wind.x = value(wind_x_, p);
  sample.wind.y = value(wind_y_, p);
  // The gradient of the bilinear surface.
  const std::vector<float>& z = *elevation_;
  const double dz_dx = ((z[p.i10] - z[p.i00]) * (1 - p.fy) + (z[p.i11] - z[p.i01]) * p.fy) / s_.cell_size;
  const double dz_dy = ((z[p.i01] - z[p.i00]) * (1 - p.fx) + (z[p.i11] - z[p.i10]) * p.fx) / s_.cell_size;
  const double length = std::sqrt(1 + dz_dx * dz_dx + dz_dy * dz_dy);
  sample.normal.x = -dz_dx / length;
  sample.normal.y = -dz_dy / length;
  sample.normal.z = 1 / length;
  sample.slope = elementary::atan(elementary::hypot(dz_dx, dz_dy));
  return sample;
}

}  // namespace desert_sim
