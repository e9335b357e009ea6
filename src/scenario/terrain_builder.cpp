#include "src/scenario/terrain_builder.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/field/random.hpp"
#include "src/core/elementary.hpp"
#include "src/scenario/sections.hpp"
#include "src/terrain/terrain.hpp"

namespace desert_sim {

namespace {

/// Position of a step's shape: its centre relative to the grid's lower-left corner [m], and the direction of
/// its axes. On a periodic axis, a cell's distance from the centre is the shortest one.
struct Placement {
  Grid grid;
  double x, y, cos = 1, sin = 0;

  template <class Step>
  Placement(const Scenario& s, const Step& step) : grid(s.make_grid()) {
    const double l = s.grid.cell_size;
    x = step.relative ? step.x * s.grid.width * l : step.x - s.grid.origin_x;
    y = step.relative ? step.y * s.grid.height * l : step.y - s.grid.origin_y;
  }
  void set_rotation(double angle_deg) {
    const elementary::UnitVector axis = elementary::direction_deg(angle_deg);
    cos = axis.x;
    sin = axis.y;
  }
  /// Position of a cell's centre relative to the shape's centre, along the shape's axes [m].
  void local(int ix, int iy, double l, double& along, double& across) const {
    double dx = (ix + 0.5) * l - x, dy = (iy + 0.5) * l - y;
    if (grid.periodic_x) dx -= grid.width * l * std::round(dx / (grid.width * l));
    if (grid.periodic_y) dy -= grid.height * l * std::round(dy / (grid.height * l));
    along = dx * cos + dy * sin;
    across = dy * cos - dx * sin;
  }
};

class Builder {
 public:
  Builder(const Scenario& scenario, const RasterLoader& load_raster)
      : s_(scenario), load_raster_(load_raster) {
    layer(Layer::bedrock);
    layer(Layer::sand);
  }

  HostLayers build() {
    for (std::size_t n = 0; n < s_.terrain.size(); ++n) {
      std::visit([&](const auto& step) { run(step); }, s_.terrain[n]);
      check(step_name(n));
    }
    return std::move(layers_);
  }

 private:
  std::string step_name(std::size_t n) const {
    const auto* raster = std::get_if<RasterStep>(&s_.terrain[n]);
    return "terrain." + std::to_string(n) + "." + terrain_step_names[s_.terrain[n].index()] +
           (raster ? " (" + raster_file(*raster) + ")" : "");
  }

  /// Path of the step's raster; empty if neither the step nor the grid names one.
  std::string raster_file(const RasterStep& p) const {
    return raster_path(s_, p.file.empty() ? s_.grid.from_raster : p.file);
  }

  std::vector<double>& layer(Layer which) {
    std::vector<double>& values = layers_[which];
    if (values.empty()) values.assign(static_cast<std::size_t>(s_.grid.width) * s_.grid.height, 0.0);
    return values;
  }

  /// Merges value(ix, iy) into all cells of the step's layer.
  template <class Value>
  void fill(const std::string& name, Merge merge, const Value& value) {
    current_layer_ = layer_by_name(name);
    std::vector<double>& values = layer(current_layer_);
#pragma omp parallel for schedule(static)
    for (int y = 0; y < s_.grid.height; ++y)
      for (int x = 0; x < s_.grid.width; ++x) {
        double& v = values[static_cast<std::size_t>(y) * s_.grid.width + x];
        const double w = value(x, y);
        v = merge == Merge::replace ? w : (merge == Merge::add ? v + w : std::max(v, w));
      }
  }

  /// Merges `value` into those cells of the step's layer for which inside(along, across) is true.
  template <class Inside>
  void fill_inside(const std::string& name, Merge merge, double value, const Placement& place,
                   const Inside& inside) {
    current_layer_ = layer_by_name(name);
    std::vector<double>& values = layer(current_layer_);
    for (int y = 0; y < s_.grid.height; ++y)
      for (int x = 0; x < s_.grid.width; ++x) {
        double along, across;
        place.local(x, y, s_.grid.cell_size, along, across);
        if (!inside(along, across)) continue;
        double& v = values[static_cast<std::size_t>(y) * s_.grid.width + x];
        v = merge == Merge::replace ? value : (merge == Merge::add ? v + value : std::max(v, value));
      }
  }

  template <class Step>
  static bool in_footprint(const Step& p, double along, double across) {
    const double a = 2 * along / std::max(p.size_x, 1e-9), b = 2 * across / std::max(p.size_y, 1e-9);
    return p.shape == Footprint::cylinder ? a * a + b * b <= 1.0 : std::abs(a) <= 1.0 && std::abs(b) <= 1.0;
  }

  void run(const UniformStep& p) {
    fill(p.layer, p.merge, [&](int, int) { return p.value; });
  }

  void run(const RampStep& p) {
    const double l = s_.grid.cell_size;
    fill(p.layer, p.merge, [&](int x, int y) {
      return p.value + p.slope_x * (x + 0.5 - 0.5 * s_.grid.width) * l +
             p.slope_y * (y + 0.5 - 0.5 * s_.grid.height) * l;
    });
  }

  void run(const NoiseStep& p) {
    const std::uint64_t seed = s_.seed + p.seed;
    fill(p.layer, p.merge, [&](int x, int y) {
      double share = p.scale > 0 ? smooth_noise(p, seed, x, y)
                                 : random_unit(seed, Purpose::terrain_noise, static_cast<std::uint32_t>(x),
                                               static_cast<std::uint32_t>(y));
      share = std::max(0.0, share - p.threshold) / std::max(1e-9, 1.0 - p.threshold);
      return p.low + (p.high - p.low) * share;
    });
  }

  /// Sum of octaves of value noise, scaled to 0…1. On a periodic axis the lattice repeats with the grid.
  double smooth_noise(const NoiseStep& p, std::uint64_t seed, int x, int y) const {
    const Grid g = s_.make_grid();
    const double l = s_.grid.cell_size, extent_x = g.width * l, extent_y = g.height * l;
    double sum = 0, total = 0, amplitude = 1, size = p.scale;
    for (int octave = 0; octave < p.octaves; ++octave, amplitude *= 0.5, size *= 0.5) {
      // The lattice spacing is rounded so that a whole number of lattice cells fits the grid.
      const int nx = std::max(1, static_cast<int>(std::lround(extent_x / (size * p.stretch))));
      const int ny = std::max(1, static_cast<int>(std::lround(extent_y / size)));
      sum += amplitude * value_noise(seed, Purpose::terrain_noise,
                                     static_cast<float>((x + 0.5) * l / extent_x * nx),
                                     static_cast<float>((y + 0.5) * l / extent_y * ny), octave + 0.5f,
                                     g.periodic_x ? nx : 0, g.periodic_y ? ny : 0);
      total += amplitude;
    }
    return std::clamp(0.5 + sum / total, 0.0, 1.0);
  }

  void run(const ConeStep& p) {
    const Placement place(s_, p);
    fill(p.layer, p.merge, [&](int x, int y) {
      double a, b;
      place.local(x, y, s_.grid.cell_size, a, b);
      const double r = std::sqrt(a * a + b * b) / p.radius;
      if (p.shape == HillShape::gaussian) return p.height * elementary::exp(-0.5 * r * r);
      if (p.shape == HillShape::dome) return p.height * std::max(0.0, 1 - r * r);
      return p.height * std::max(0.0, 1 - r);
    });
  }

  void run(const ColumnStep& p) {
    Placement place(s_, p);
    place.set_rotation(p.angle_deg);
    fill_inside(p.layer, p.merge, p.height, place, [&](double a, double b) { return in_footprint(p, a, b); });
  }

  void run(const ObstacleStep& p) {
    Placement place(s_, p);
    place.set_rotation(p.angle_deg);
    const auto inside = [&](double a, double b) { return in_footprint(p, a, b); };
    fill_inside("bedrock", Merge::add, p.height, place, inside);
    fill_inside("obstacle", Merge::replace, 1.0, place, inside);
  }

  void run(const DiscsStep& p) {
    current_layer_ = layer_by_name(p.layer);
    std::vector<double>& values = layer(current_layer_);
    std::vector<char> covered(values.size(), 0);
    const Grid g = s_.make_grid();
    const double l = s_.grid.cell_size;
    const auto wanted = static_cast<std::size_t>(p.coverage * static_cast<double>(values.size()));
    std::size_t count = 0;
    for (std::uint32_t n = 0; count < wanted && n < 10000000; ++n) {
      const auto draw = [&](std::uint32_t k) {
        return random_unit(s_.seed + p.seed, Purpose::terrain_discs, n, k);
      };
      const int cx = static_cast<int>(draw(0) * g.width), cy = static_cast<int>(draw(1) * g.height);
      const double r = (p.radius_low + (p.radius_high - p.radius_low) * draw(2)) / l;
      const int reach = static_cast<int>(std::min(std::ceil(r), 1.0 * std::max(g.width, g.height)));
      for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx) {
          const double distance2 = 1.0 * dx * dx + 1.0 * dy * dy;
          const int i = distance2 <= r * r ? neighbour_index(g, cx + dx, cy + dy) : -1;
          if (i < 0) continue;
          double& v = values[static_cast<std::size_t>(i)];
          v = p.merge == Merge::replace ? p.height
                                        : (p.merge == Merge::add ? v + p.height : std::max(v, p.height));
          count += covered[static_cast<std::size_t>(i)] ? 0 : 1;
          covered[static_cast<std::size_t>(i)] = 1;
        }
    }
  }

  void run(const RipplesStep& p) {
    const double l = s_.grid.cell_size;
    const elementary::UnitVector downwind = elementary::direction_deg(p.direction_deg);
    const double x0 = p.relative ? p.x * s_.grid.width * l : p.x - s_.grid.origin_x,
                 y0 = p.relative ? p.y * s_.grid.height * l : p.y - s_.grid.origin_y;
    fill(p.layer, p.merge, [&](int x, int y) {
      const double waves =
          (((x + 0.5) * l - x0) * downwind.x + ((y + 0.5) * l - y0) * downwind.y) / p.wavelength;
      const double number = std::floor(waves), phase = waves - number;
      if (p.count > 0 && (number < 0 || number >= p.count)) return 0.0;
      return p.height * (phase < p.windward ? phase / p.windward : (1 - phase) / (1 - p.windward));
    });
  }

  void run(const RasterStep& p) {
    RasterRequest request;
    request.path = raster_file(p);
    if (request.path.empty())
      throw ConfigError(s_.name + ": terrain: raster: file is empty, and grid.from_raster is empty too");
    request.band = p.band;
    request.scale = p.scale;
    request.offset = p.offset;
    request.encoding = p.encoding;
    request.nodata = p.nodata;
    request.fill_nodata = p.fill_nodata;
    request.complete = p.complete;
    request.width = s_.grid.width;
    request.height = s_.grid.height;
    request.cell_size = s_.grid.cell_size;
    request.origin_x = s_.grid.origin_x;
    request.origin_y = s_.grid.origin_y;
    request.stretch = p.stretch;
    const RasterField raster = load_raster_(request);
    fill(p.layer, p.merge, [&](int x, int y) {
      return static_cast<double>(raster.values[static_cast<std::size_t>(y) * s_.grid.width + x]);
    });
  }

  /// Sets depths that a step made negative to 0, and throws ConfigError for any other value out of range.
  void check(const std::string& step) {
    const LayerInfo& row = info(current_layer_);
    std::vector<double>& values = layers_[current_layer_];
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (row.lowest == 0 && values[i] < 0) values[i] = 0;
      if (!(values[i] >= row.lowest && values[i] <= row.highest))
        throw ConfigError(s_.name + ": " + step + ": layer " + row.name + " would be " +
                          std::to_string(values[i]) + " at cell (" + std::to_string(i % s_.grid.width) +
                          ", " + std::to_string(i / s_.grid.width) + "); allowed: [" +
                          std::to_string(row.lowest) + ", " + std::to_string(row.highest) + "] " + row.unit);
    }
  }

  const Scenario& s_;
  const RasterLoader& load_raster_;
  HostLayers layers_;
  Layer current_layer_ = Layer::bedrock;
};

}  // namespace

HostLayers build_terrain(const Scenario& scenario, const RasterLoader& load_raster) {
  return Builder(scenario, load_raster).build();
}

}  // namespace desert_sim
