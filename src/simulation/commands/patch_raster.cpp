#include "src/simulation/commands/patch_raster.hpp"

#include <algorithm>

#include "src/core/error.hpp"
#include "src/core/quoted.hpp"

namespace desert_sim {

command::Patch patch_of_raster(const RasterLoader& load_raster, const std::string& path,
                               const std::string& name, std::optional<double> scale) {
  RasterRequest request;
  request.path = path;
  const RasterField grid = load_raster(request);
  const auto cells = static_cast<long long>(grid.width) * grid.height;
  if (cells > command::Patch::max_pixels)
    throw ConfigError("image_file: " + in_quotes(name) + " has " + std::to_string(grid.width) + " x " +
                      std::to_string(grid.height) + " cells (allowed: at most " +
                      std::to_string(command::Patch::max_pixels) + " in all)");
  request.width = grid.width, request.height = grid.height;
  request.cell_size = grid.cell_size, request.origin_x = grid.origin_x, request.origin_y = grid.origin_y;
  const std::vector<float> values = load_raster(request).values;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double range = static_cast<double>(*high) - *low;
  command::Patch patch{grid.width, grid.height, {}};
  patch.values.reserve(values.size());
  for (int row = grid.height - 1; row >= 0; --row)  // a patch begins in the north, as a picture does
    for (int column = 0; column < grid.width; ++column) {
      const double value = values[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.width) +
                                  static_cast<std::size_t>(column)];
      patch.values.push_back(
          static_cast<float>(scale ? value * *scale : (range > 0 ? (value - *low) / range : 1)));
    }
  return patch;
}

}  // namespace desert_sim
