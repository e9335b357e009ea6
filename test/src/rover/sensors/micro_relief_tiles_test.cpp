// Beams ask for the micro-relief of cells that they may reach: scans have the bits that they have after all
// cells were computed, cells the bits of a plain loop over the whole terrain, and offsets those that follow
// without patches and heaps that were computed before.

#include <cstring>

#include "kernels/sand/saltation_inputs.hpp"
#include "src/simulation/views/micro_relief.hpp"
#include "src/simulation/views/snapshot_source.hpp"
#include "test/support/scenes.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

/// Dunes with thin sand, ponds, moist ground, shade, holes in the map and, if asked for, plants and stones.
class RandomTerrain {
 public:
  explicit RandomTerrain(unsigned seed) : random_(seed) {}

  Snapshot snapshot(bool periodic) {
    Snapshot s;
    s.width = static_cast<int>(between(20, 400));
    s.height = static_cast<int>(between(20, 400));
    s.cell_size = between(0.2, 0.8);
    s.origin_x = between(-900, 900);
    s.origin_y = s.micro_relief.origin_y = between(-900, 900);
    s.periodic_x = s.periodic_y = s.micro_relief.periodic_y = periodic;
    s.micro_relief.grid_height = s.height;
    s.micro_relief.seed = random_();
    s.micro_relief.parameters.crest_length = static_cast<float>(between(0.4, 2.5));
    s.micro_relief.parameters.bump_radius = static_cast<float>(between(0.1, 0.9));
    s.micro_relief.moisture_capacity = 0.3f;
    change(s);
    return s;
  }
  /// Another state of the same grid.
  void change(Snapshot& s) {
    s.wind_above = {static_cast<float>(between(4, 12)), static_cast<float>(between(-5, 5))};
    s.micro_relief.wind = RippleWind::settled(s.wind_above);
    s.layers.clear();
    const double phase = between(0, 6);
    fill(s, Layer::elevation, [&](int x, int y) {
      return between(0, 1) < 0.002 ? std::nan("")
                                   : 0.8 * std::sin(phase + 0.21 * x) * std::cos(0.16 * y) + between(0, 0.05);
    });
    fill(s, Layer::sand,
         [&](int x, int y) { return std::max(0.0, 0.1 + 0.2 * std::sin(0.3 * x - 0.2 * y)); });
    fill(s, Layer::wind_x, [&](int, int) { return between(0.4, 1.4) * double{s.wind_above.x}; });
    fill(s, Layer::wind_y, [&](int, int) { return between(0.4, 1.4) * double{s.wind_above.y}; });
    const auto sometimes = [&](Layer layer, double share, double most) {
      if (between(0, 1) < 0.3) return;
      fill(s, layer, [&](int, int) { return between(0, 1) < share ? between(0, most) : 0.0; });
    };
    sometimes(Layer::soil, 0.5, 0.5);
    sometimes(Layer::moisture, 0.5, 0.02);
    sometimes(Layer::water, 0.05, 0.004);
    sometimes(Layer::wind_shadow, 0.3, 1);
    sometimes(Layer::obstacle, 0.05, 1);
    sometimes(Layer::vegetation, 0.3, 1);
    s.micro_relief.plants_live = between(0, 1) < 0.3;
    if (s.micro_relief.plants_live) add_feet(s);
  }
  SensorPose pose(const Snapshot& s, double beyond, double highest = 2) {
    const double x = between(-beyond, s.width * s.cell_size + beyond),
                 y = between(-beyond, s.height * s.cell_size + beyond);
    return pose_from_angles(s.origin_x + x, s.origin_y + y, between(1, highest), between(-8, 8),
                            between(-8, 20), between(0, 360));
  }
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

 private:
  template <class Value>
  void fill(Snapshot& s, Layer layer, const Value& value) {
    std::vector<float>& values = s.layers[layer];
    for (int y = 0; y < s.height; ++y)
      for (int x = 0; x < s.width; ++x) values.push_back(static_cast<float>(value(x, y)));
  }
  void add_feet(Snapshot& s) {
    const auto feet = std::make_shared<PlantFeet>();
    const micro_relief::Lattice squares = s.micro_relief.bump_squares(s.width, s.cell_size, s.periodic_x);
    feet->rows = squares.y.count;
    for (int n = 0; n < squares.x.count * squares.y.count; ++n) {
      const auto share = [this] { return static_cast<float>(between(0, 1)); };
      const micro_relief::Lattice::Square at{0, 0, share(), share()};
      feet->widest.push_back(between(0, 1) < 0.6 ? 0 : micro_relief::Foot::number(at, 0.6f * share()));
    }
    s.feet = feet;
  }
  std::mt19937 random_;
};

struct SceneOfTiles : HeightFieldScene {
  SceneOfTiles(Exec& exec, const Snapshot& s)
      : HeightFieldScene(exec, {s.width, s.height, s.cell_size, s.origin_x, s.origin_y}) {
    show(s);
  }
  void show(const Snapshot& s) {
    update(SceneLayer::elevation, s.layers.at(Layer::elevation));
    set_micro_relief(source_of(s));
  }
  micro_relief::Relief of_all_cells() { return micro_relief()->within(0, 0, 1e5, 1).relief; }
};

class TilesOfMicroRelief : public test::OnBackend {
 protected:
  /// A scan where cells are computed as they are asked for, and one where all were computed before.
  template <class Sensor>
  void expect_same_scan(Sensor& sensor, SceneOfTiles& lazy, SceneOfTiles& whole, const SensorPose& pose) {
    const RangeImage some = sensor.scan(lazy, pose, scans_), all = sensor.scan(whole, pose, scans_);
    ASSERT_TRUE(test::same_bits(some.distances, all.distances)) << "scan " << scans_;
    ASSERT_TRUE(test::same_bits(some.intensities, all.intensities)) << "scan " << scans_;
    returns_ += test::returns_of(some);
    whole.clear_micro_relief();
    off_the_bilinear_ground_ += !test::same_bits(sensor.scan(whole, pose, scans_).distances, some.distances);
    ++scans_;
  }
  unsigned scans_ = 0;
  int returns_ = 0, off_the_bilinear_ground_ = 0;
};

TEST_P(TilesOfMicroRelief, ScansHaveTheBitsOfTheWholeTerrain) {
  LidarParameters l = test::exact_lidar(12, 150, -50, 2);
  DepthCameraParameters c;
  c.width = 40;
  c.height = 30;
  std::size_t computed = 0, cells = 0;
  for (unsigned seed = 0; seed < 14; ++seed) {
    RandomTerrain terrain(seed);
    Snapshot s = terrain.snapshot(seed % 2);
    l.range_max = static_cast<float>(terrain.between(2, 40));
    c.far = static_cast<float>(terrain.between(1, 8));
    Lidar lidar(exec(), l);
    DepthCamera camera(exec(), c);
    SceneOfTiles lazy(exec(), s);
    for (int state = 0; state < 3; ++state) {
      for (int n = 0; n < 3; ++n) {
        SceneOfTiles whole(exec(), s);
        whole.of_all_cells();
        const SensorPose pose =
            terrain.pose(s, n == 0 ? 0.0 : 3.0, n == 1 ? 2 + 0.5 * double{l.range_max} : 2);
        expect_same_scan(lidar, lazy, whole, pose);
        whole.show(s);
        whole.of_all_cells();
        expect_same_scan(camera, lazy, whole, pose);
      }
      computed += lazy.micro_relief()->computed_cells();
      cells += static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height);
      terrain.change(s);
      lazy.show(s);
    }
  }
  EXPECT_GT(returns_, 50000);
  EXPECT_GT(off_the_bilinear_ground_, 150);
  EXPECT_LT(computed, cells * 7 / 10) << "beams do not reach all cells";
}

DESERT_ON_EACH_BACKEND(TilesOfMicroRelief);

/// A plain loop over all cells.
struct PlainCells {
  std::vector<float> mobile, level, turn_x, turn_y;

  explicit PlainCells(const Snapshot& s) {
    const auto cells = static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height);
    const std::vector<float> nowhere(cells, 0.0f);
    const auto layer = [&](Layer which) -> const std::vector<float>& {
      return s.find(which) ? *s.find(which) : nowhere;
    };
    const std::vector<float>& z = layer(Layer::elevation);
    for (std::vector<float>* const values : {&mobile, &level, &turn_x, &turn_y}) values->assign(cells, 0.0f);
    const MicroReliefSettings& p = s.micro_relief;
    const wind::Vector above = s.wind_above;
    const float square = above.x * above.x + above.y * above.y;
    for (int y = 0; y < s.height; ++y)
      for (int x = 0; x < s.width; ++x) {
        const auto at = [&](int i, int j) {
          return static_cast<std::size_t>(
              sample_index({s.width, s.height, 1.0f, s.periodic_x, s.periodic_y}, i, j));
        };
        const std::size_t i = at(x, y);
        const float u = layer(Layer::wind_x)[i], v = layer(Layer::wind_y)[i];
        turn_x[i] = (u * above.x + v * above.y) / square;
        turn_y[i] = (v * above.x - u * above.y) / square;
        const float slope = hypotenuse(z[at(x + 1, y)] - z[at(x - 1, y)], z[at(x, y + 1)] - z[at(x, y - 1)]) /
                            static_cast<float>(2 * s.cell_size);
        if (std::isnan(slope) || std::isnan(z[i])) continue;
        level[i] = 1.0f - micro_relief::smooth_step((slope / p.repose_tangent - 0.75f) * 4.0f);
        const float capacity = p.moisture_capacity * std::clamp(layer(Layer::soil)[i] + layer(Layer::sand)[i],
                                                                repose::least_moist_depth, p.moisture_depth);
        mobile[i] = (1.0f - layer(Layer::wind_shadow)[i]) *
                    (1.0f - std::clamp(layer(Layer::obstacle)[i], 0.0f, 1.0f)) *
                    (1.0f - micro_relief::smooth_step(layer(Layer::water)[i] / 0.002f)) *
                    saltation::Dryness(p.moisture_cutoff)(layer(Layer::moisture)[i] / capacity);
      }
  }
};

TEST(SquaresOfMicroRelief, OffsetsAreThoseWithoutThem) {
  const std::unique_ptr<Exec> exec = make_exec("cpu", 1);
  int inside = 0, outside = 0, uneven = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    RandomTerrain terrain(200 + seed);
    const Snapshot s = terrain.snapshot(seed % 2);
    SceneOfTiles scene(*exec, s);
    scene.of_all_cells();
    const SensorPose pose = terrain.pose(s, 2);
    const ray_march::RippledGround ground = scene.micro_relief()->within(
        pose.position.x(), pose.position.y(), terrain.between(1, 30), 1u << (seed % 12));
    for (int n = 0; n < 2000; ++n) {
      const double x = terrain.between(0, s.width * s.cell_size),
                   y = terrain.between(0, s.height * s.cell_size);
      const float offset = ground.known.offset(ground.relief, x, y);
      ASSERT_EQ(bits_of(offset), bits_of(ground.relief.offset(x, y))) << seed << ": " << x << ", " << y;
      const micro_relief::Lattice::Square at = ground.relief.ripples.lattice.square(x, y);
      ++(ground.known.patch_box.find(at.i, at.j) >= 0 ? inside : outside);
      uneven += offset != 0;
    }
  }
  EXPECT_GT(inside, 2000);
  EXPECT_GT(outside, 2000);
  EXPECT_GT(uneven, 10000);
}

bool same_cells(const std::vector<float>& expected, const float* values) {
  return std::memcmp(expected.data(), values, expected.size() * sizeof(float)) == 0;
}

TEST(CellsOfMicroRelief, AreThoseOfAPlainLoop) {
  const std::unique_ptr<Exec> exec = make_exec("cpu", 1);
  for (unsigned seed = 0; seed < 12; ++seed) {
    RandomTerrain terrain(100 + seed);
    const Snapshot s = terrain.snapshot(seed % 2);
    const PlainCells plain(s);
    SceneOfTiles scene(*exec, s);
    const MicroRelief of_snapshot(s);
    for (const micro_relief::Relief& relief : {scene.of_all_cells(), of_snapshot.relief()}) {
      EXPECT_TRUE(same_cells(plain.mobile, relief.cells.mobile)) << seed;
      EXPECT_TRUE(same_cells(plain.level, relief.cells.level)) << seed;
      EXPECT_TRUE(same_cells(plain.turn_x, relief.cells.turn_x)) << seed;
      EXPECT_TRUE(same_cells(plain.turn_y, relief.cells.turn_y)) << seed;
      EXPECT_TRUE(same_cells(s.layers.at(Layer::sand), relief.cells.sand)) << seed;
      EXPECT_EQ(relief.bumps.height, of_snapshot.relief().bumps.height) << seed;
    }
  }
}

}  // namespace
}  // namespace desert_sim
