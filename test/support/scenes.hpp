#pragma once
/// Terrains for tests of sensors, and rays over them that are followed in tiny steps.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "kernels/backend/exec.hpp"
#include "src/rover/sensors/depth_camera.hpp"
#include "src/rover/sensors/lidar.hpp"

namespace desert_sim::test {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

using CellValue = std::function<float(int x, int y)>;

inline std::vector<float> values_of(const SceneGeometry& g, const CellValue& value) {
  std::vector<float> values;
  for (int y = 0; y < g.height; ++y)
    for (int x = 0; x < g.width; ++x) values.push_back(value(x, y));
  return values;
}

/// A scene whose heights a test knows, too.
class KnownScene {
 public:
  KnownScene(Exec& exec, const SceneGeometry& geometry, const CellValue& elevation)
      : scene(exec, geometry), heights(values_of(geometry, elevation)) {
    scene.update(SceneLayer::elevation, heights);
  }
  void set(SceneLayer layer, const CellValue& value) {
    scene.update(layer, values_of(scene.geometry(), value));
  }

  /// The height of the surface at a place [m]: bilinear between the centres of cells, constant beyond the
  /// outermost ones; NaN outside the grid.
  double height_at(double x, double y) const {
    const SceneGeometry& g = scene.geometry();
    const double east = (x - g.origin_x) / g.cell_size, north = (y - g.origin_y) / g.cell_size;
    if (!(east >= 0 && east <= g.width && north >= 0 && north <= g.height))
      return std::numeric_limits<double>::quiet_NaN();
    const double u = std::clamp(east - 0.5, 0.0, g.width - 1.0),
                 v = std::clamp(north - 0.5, 0.0, g.height - 1.0);
    const int i = std::min(static_cast<int>(u), std::max(g.width - 2, 0)),
              j = std::min(static_cast<int>(v), std::max(g.height - 2, 0));
    const auto h = [&](int a, int b) {
      return static_cast<double>(
          heights[static_cast<std::size_t>(std::min(b, g.height - 1)) * g.width + std::min(a, g.width - 1)]);
    };
    const double a = u - i, b = v - j;
    return (h(i, j) * (1 - a) + h(i + 1, j) * a) * (1 - b) +
           (h(i, j + 1) * (1 - a) + h(i + 1, j + 1) * a) * b;
  }

  HeightFieldScene scene;
  std::vector<float> heights;
};

struct Point {
  double x, y, z;
};

/// Where the beam with this direction in the sensor's frame is at a distance.
inline Point point_at(const SensorPose& pose, const beams::Vec3& direction, double distance) {
  const Eigen::Vector3f along(direction.x, direction.y, direction.z);
  const Eigen::Vector3d p = pose.position + distance * (rotation_of(pose) * along.cast<double>());
  return {p.x(), p.y(), p.z()};
}

/// The first distance at which the beam is below the surface, in steps of `step` that are then halved; empty
/// if it is not up to `end`. Ways below the surface that are shorter than a step are missed.
inline std::optional<double> by_steps(const KnownScene& known, const SensorPose& pose,
                                      const beams::Vec3& direction, double step, double end) {
  const auto below = [&](double t) {
    const Point p = point_at(pose, direction, t);
    return p.z <= known.height_at(p.x, p.y);
  };
  for (double t = 0; t <= end; t += step) {
    if (!below(t)) continue;
    double low = std::max(t - step, 0.0), high = t;
    for (int n = 0; n < 50; ++n) (below(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
    return high;
  }
  return std::nullopt;
}

/// A lidar without noise; the beams of a single column and ring look straight ahead.
inline LidarParameters exact_lidar(int rings, int columns, float lowest_deg, float highest_deg) {
  LidarParameters p;
  p.rings = rings;
  p.columns = columns;
  p.lowest_deg = lowest_deg;
  p.highest_deg = highest_deg;
  p.noise = 0;
  p.range_min = 0;
  return p;
}

/// One beam from `pose` along its x axis.
inline LidarParameters single_beam(float range_max = 1000) {
  LidarParameters p = exact_lidar(1, 1, 0, 0);
  p.first_azimuth_deg = -1;
  p.last_azimuth_deg = 1;
  p.range_max = range_max;
  return p;
}

inline int returns_of(const RangeImage& image) {
  return static_cast<int>(
      std::count_if(image.distances.begin(), image.distances.end(), [](float d) { return !std::isnan(d); }));
}

inline float rough_ground(int x, int y) {
  return 4 * std::sin(0.21f * static_cast<float>(x)) + static_cast<float>((x * 7 + y * 13) % 11) * 0.2f;
}

/// Rough ground with plants and airborne sand.
inline void fill_with_all(HeightFieldScene& scene, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  const SceneGeometry& g = scene.geometry();
  const auto some = [&](float share, float most) {
    return values_of(g, [&](int, int) { return unit(random) < share ? most * unit(random) : 0.0f; });
  };
  scene.update(SceneLayer::elevation, values_of(g, rough_ground));
  scene.update(SceneLayer::canopy_height, some(0.3f, 1));
  scene.update(SceneLayer::vegetation, some(0.5f, 1));
  scene.update(SceneLayer::airborne_sand, some(1, 0.2f));
}

/// A lidar of more beams than one thread is left with.
inline LidarParameters noisy_lidar() {
  LidarParameters p;
  p.rings = 48;
  p.columns = 400;
  p.noise_per_metre = 0.001f;
  p.dropout = 0.01f;
  return p;
}

/// The same bits, with NaN equal to NaN.
inline bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](float x, float y) {
           return x == y || (std::isnan(x) && std::isnan(y));
         });
}

}  // namespace desert_sim::test
