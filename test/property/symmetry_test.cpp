// A start that is shifted, mirrored or turned gives the shifted, mirrored or turned result: bit for bit
// where no cell moves a few quanta, and elsewhere but for the dice of these (kernels/field/dice.hpp). Their
// differences grow, so that few steps are compared there. Without warping and projection, whose transforms
// round differently, and with the scheme `sweeps`.

#include <cstdlib>
#include <functional>
#include <random>

#include "support/world.hpp"

namespace desert_sim {
namespace {

/// Where cell (x, y) goes, and the wind that goes with it.
struct Motion {
  std::string name;
  std::function<void(int, int, int, int&, int&)> move;  ///< (x, y, n) -> (x', y') on an n × n grid
  std::function<double(double)> turn;                   ///< wind direction [deg]
};

std::vector<Motion> motions() {
  return {
      {"shifted by (5, 11)",
       [](int x, int y, int n, int& u, int& v) {
         u = (x + 5) % n;
         v = (y + 11) % n;
       },
       [](double d) { return d; }},
      {"mirrored in x",
       [](int x, int y, int n, int& u, int& v) {
         u = n - 1 - x;
         v = y;
       },
       [](double d) { return 180 - d; }},
      {"mirrored in y",
       [](int x, int y, int n, int& u, int& v) {
         u = x;
         v = n - 1 - y;
       },
       [](double d) { return -d; }},
      {"transposed",
       [](int x, int y, int, int& u, int& v) {
         u = y;
         v = x;
       },
       [](double d) { return 90 - d; }},
      {"turned by 90 degrees",
       [](int x, int y, int n, int& u, int& v) {
         u = n - 1 - y;
         v = x;
       },
       [](double d) { return d + 90; }},
      {"turned by 180 degrees",
       [](int x, int y, int n, int& u, int& v) {
         u = n - 1 - x;
         v = n - 1 - y;
       },
       [](double d) { return d + 180; }},
  };
}

constexpr int n = 40;
const std::vector<Layer> moved_layers{
    Layer::bedrock,    Layer::soil,     Layer::sand,     Layer::airborne_sand,
    Layer::vegetation, Layer::moisture, Layer::obstacle, Layer::erosion_resistance};

std::vector<std::uint32_t> moved(const std::vector<std::uint32_t>& from, const Motion& m) {
  std::vector<std::uint32_t> to(from.size());
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      int u, v;
      m.move(x, y, n, u, v);
      to[static_cast<std::size_t>(v * n + u)] = from[static_cast<std::size_t>(y * n + x)];
    }
  return to;
}

/// 1e-4 of the relief of 13 m [quanta].
constexpr long long by_dice = 1363;

/// Of two stored values [quanta]; of real ones whether they differ at all.
long long difference(Layer layer, std::uint32_t a, std::uint32_t b) {
  if (info(layer).storage == Storage::real) return a == b ? 0 : wall_height;
  return static_cast<long long>(static_cast<Quanta>(a)) - static_cast<Quanta>(b);
}

const char* const smooth_start =
    "terrain:\n"
    "  - noise: {layer: bedrock, low: 0, high: 8, scale: 20}\n"
    "  - noise: {layer: sand, low: 0, high: 5, scale: 16, threshold: 0.3, seed: 2}\n";

class Symmetry : public test::OnBackend {
 protected:
  std::string yaml(const std::string& more, const char* boundary, double direction) const {
    return "grid: {width: 40, height: 40, boundary: " + std::string(boundary) + "}\n" + more +
           "\nwind: {warping: false, projection: false, speed: 5, direction_deg: " +
           std::to_string(direction) + "}\n";
  }

  /// The moved world's layers are set from the plain one's through a checkpoint-free way: its terrain is
  /// const, so that both start from layers written by the same edits of the words.
  void expect_equivariant(const std::string& more, const char* boundary = "periodic", double direction = 30,
                          int steps = 5, long long tolerance = by_dice) {
    for (const Motion& m : motions()) {
      if (std::string(boundary) == "open" && m.name.rfind("shifted", 0) == 0) continue;
      SCOPED_TRACE(m.name + ", " + boundary + ", wind to " + std::to_string(direction) + " degrees");
      auto plain = simulation(yaml(more, boundary, direction));
      auto other = simulation(yaml(more, boundary, m.turn(direction)));
      Terrain& terrain = const_cast<Terrain&>(other->terrain());
      for (Layer layer : moved_layers)
        if (terrain.has(layer)) terrain.set_raw_words(layer, moved(plain->terrain().raw_words(layer), m));
      // The winds themselves must be mirror images, or the test would ask too much.
      const wind::Vector a = plain->wind_above(), b = other->wind_above();
      ASSERT_TRUE(std::abs(a.x) == std::abs(b.x) || std::abs(a.x) == std::abs(b.y))
          << "choose another direction";
      for (int step = 1; step <= steps; ++step) {
        plain->step();
        other->step();
        for (Layer layer : moved_layers) {
          if (!terrain.has(layer)) continue;
          const auto expected = moved(plain->terrain().raw_words(layer), m), found = terrain.raw_words(layer);
          long long largest = 0;
          for (std::size_t i = 0; i < expected.size(); ++i)
            largest = std::max(largest, std::abs(difference(layer, expected[i], found[i])));
          ASSERT_LE(largest, tolerance) << "quanta of " << info(layer).name << " after step " << step;
        }
      }
    }
  }
};

const std::string sweeps = "avalanching: {scheme: sweeps, sweeps: 10}\n";
const std::string start = smooth_start;

TEST_P(Symmetry, OfSaltationAlone) {
  expect_equivariant(
      start + "avalanching: {enabled: false}\nreptation: {method: 'off'}\nwind_shadow: {enabled: false}\n",
      "periodic", 30, 15, 0);
}
TEST_P(Symmetry, OfWindShadow) { expect_equivariant(start + "avalanching: {enabled: false}\n"); }
TEST_P(Symmetry, OfWindShadowAtSixtyDegrees) {
  expect_equivariant(start + "avalanching: {enabled: false}\n", "periodic", 60);
}
TEST_P(Symmetry, OfWindShadowAlongTheAxis) {
  expect_equivariant(start + "avalanching: {enabled: false}\n", "periodic", 0);
}
TEST_P(Symmetry, OfCurvedWindShadow) {
  expect_equivariant(start + "avalanching: {enabled: false}\nwind_shadow: {curved: true}\n", "periodic", 30);
}
TEST_P(Symmetry, OfCurvedWindShadowAtSixtyDegrees) {
  expect_equivariant(start + "avalanching: {enabled: false}\nwind_shadow: {curved: true}\n", "periodic", 60);
}
TEST_P(Symmetry, OfAdaptiveRepose) { expect_equivariant(start + sweeps); }
TEST_P(Symmetry, OfSmoothing) {
  expect_equivariant(start + sweeps + "reptation: {method: smoothing, strength: 0.5}\n");
}
TEST_P(Symmetry, OfTaylorKeyser) {
  expect_equivariant(start + "avalanching: {scheme: taylor_keyser, sweeps: 10}\n");
}
TEST_P(Symmetry, OfConvergedSweeps) {
  expect_equivariant(
      start + "avalanching: {scheme: sweeps, quality: converged, sweeps: 10, max_iterations: 60}\n",
      "periodic", 30, 5);
}
TEST_P(Symmetry, OfAbrasionSoilAndBedrock) {
  expect_equivariant(start +
                     "  - noise: {layer: soil, low: 0, high: 3, scale: 14, threshold: 0.5, seed: 3}\n"
                     "  - noise: {layer: erosion_resistance, low: 0, high: 1, scale: 14, seed: 4}\n"
                     "  - cone: {layer: bedrock, x: 13, y: 21, radius: 5, height: 20}\n"
                     "abrasion: {rate: 0.02, cover: 0.5}\n" +
                     sweeps);
}
TEST_P(Symmetry, OfVegetationAndMoisture) {
  expect_equivariant(start +
                     "  - noise: {layer: vegetation, low: 0, high: 1, scale: 14, threshold: 0.4, seed: 5}\n"
                     "  - noise: {layer: moisture, low: 0, high: 0.3, scale: 14, threshold: 0.5, seed: 6}\n" +
                     sweeps);
}
TEST_P(Symmetry, OfObstacles) {
  expect_equivariant(
      start + "  - obstacle: {x: 12, y: 25, size_x: 9, size_y: 5, angle_deg: 20, height: 6}\n" + sweeps);
}
TEST_P(Symmetry, OfEchoDunes) {
  const std::string cliff = "  - column: {layer: bedrock, x: 22, y: 18, size_x: 8, size_y: 14, height: 9}\n";
  expect_equivariant(start + cliff + "echo_dunes: {enabled: true}\n" + sweeps, "periodic", 30);
}
TEST_P(Symmetry, OfEchoDunesAtSixtyDegrees) {
  const std::string cliff = "  - column: {layer: bedrock, x: 22, y: 18, size_x: 8, size_y: 14, height: 9}\n";
  expect_equivariant(start + cliff + "echo_dunes: {enabled: true}\n" + sweeps, "periodic", 60);
}
TEST_P(Symmetry, OfOpenEdgesWithInflux) {
  expect_equivariant(start + sweeps + "saltation: {influx: 0.3}\n", "open");
}

/// Closed tiles: shifts by the widest tile are exact, whatever the levels.
TEST_P(Symmetry, OfMultilevelUnderShiftsByTheCoarsestTile) {
  const std::string text =
      "grid: {width: 256, height: 256, cell_size: 1}\n"
      "terrain: [noise: {layer: bedrock, low: 0, high: 12, scale: 50}, noise: {layer: sand, low: 3, high: 9, "
      "scale: 40, seed: 2}]\n"
      "wind: {warping: false, projection: false, speed: 6, direction_deg: 30}\n"
      "wind_shadow: {enabled: false}\navalanching: {scheme: multilevel, coarsest_cell: 4}\n";
  constexpr int size = 256, shift = 32 * 4;  // tile × 2^levels
  auto plain = simulation(text), other = simulation(text);
  Terrain& terrain = const_cast<Terrain&>(other->terrain());
  const auto shifted = [&](const std::vector<std::uint32_t>& from) {
    std::vector<std::uint32_t> to(from.size());
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        to[static_cast<std::size_t>(((y + shift) % size) * size + (x + shift) % size)] =
            from[static_cast<std::size_t>(y * size + x)];
    return to;
  };
  for (Layer layer : {Layer::bedrock, Layer::sand})
    terrain.set_raw_words(layer, shifted(plain->terrain().raw_words(layer)));
  test::run(*plain, 8);
  test::run(*other, 8);
  EXPECT_TRUE(shifted(plain->terrain().raw_words(Layer::sand)) == terrain.raw_words(Layer::sand)) << "sand";
  EXPECT_TRUE(shifted(plain->terrain().raw_words(Layer::airborne_sand)) ==
              terrain.raw_words(Layer::airborne_sand))
      << "airborne_sand";
}

DESERT_ON_EACH_BACKEND(Symmetry);

}  // namespace
}  // namespace desert_sim
