// A start that is shifted, mirrored or turned gives the shifted, mirrored or turned result. Dice round small
// amounts (kernels/field/dice.hpp) and depend on the number of the cell, so that moved worlds roll others:
//
// - Where no cell moves less than 256 quanta, the moved result is that of the moved start bit for bit.
// - Where flows become small, as those of smoothing do on level ground, it is within 1e-4 of the relief, as
//   long as no avalanche and no shadow of the wind makes small differences grow.
// - Elsewhere the moved worlds of many seeds are compared with the plain ones of other seeds.
//
// All after 20 steps, without warping and projection, whose transforms round differently, and with the scheme
// `sweeps`.

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>

#include "test/support/world.hpp"

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
constexpr long long small_share_of_relief = 1363;

/// Of two stored values [quanta]; of real ones whether they differ at all.
long long difference(Layer layer, std::uint32_t a, std::uint32_t b) {
  if (info(layer).storage == Storage::real) return a == b ? 0 : wall_height;
  return static_cast<long long>(static_cast<Quanta>(a)) - static_cast<Quanta>(b);
}

/// Sand lies everywhere, and slides.
const std::string deep =
    "terrain:\n"
    "  - noise: {layer: bedrock, low: 0, high: 8, scale: 20}\n"
    "  - noise: {layer: sand, low: 5, high: 12, scale: 8}\n";
/// Sand and bare ground, on which what is in the air dwindles.
const std::string patchy =
    "terrain:\n"
    "  - noise: {layer: bedrock, low: 0, high: 8, scale: 20}\n"
    "  - noise: {layer: sand, low: 0, high: 5, scale: 16, threshold: 0.3}\n";
const std::string cliff =
    "  - column: {layer: bedrock, x: 22, y: 18, size_x: 8, size_y: 14, height: 9}\n"
    "echo_dunes: {enabled: true}\n";
const std::string sweeps = "avalanching: {scheme: sweeps, sweeps: 10}\n";
const std::string no_avalanches = "avalanching: {enabled: false}\n";
/// Of no slope the shadow is so nearly full that hardly any sand is lifted.
const std::string faint = "wind_shadow: {full_deg: 80}\n",
                  faint_curved = "wind_shadow: {full_deg: 80, curved: true}\n";

/// The values of a layer in several worlds.
struct Sample {
  std::vector<std::vector<double>> worlds;

  void add(Layer layer, const std::vector<std::uint32_t>& words) {
    std::vector<double>& values = worlds.emplace_back();
    for (std::uint32_t word : words) {
      float real;
      std::memcpy(&real, &word, sizeof real);
      values.push_back(info(layer).storage == Storage::real ? real : static_cast<Quanta>(word));
    }
  }
  double mean(std::size_t i) const {
    double sum = 0;
    for (const auto& world : worlds) sum += world[i];
    return sum / static_cast<double>(worlds.size());
  }
  /// Of the mean.
  double variance(std::size_t i) const {
    double sum = 0;
    const double middle = mean(i), count = static_cast<double>(worlds.size());
    for (const auto& world : worlds) sum += (world[i] - middle) * (world[i] - middle);
    return sum / (count * (count - 1));
  }
  /// Root mean square, over the cells that scatter, of the distance of the means in standard errors; infinite
  /// if cells that do not scatter differ.
  double standard_errors_to(const Sample& o) const {
    double sum = 0;
    int cells = 0;
    for (std::size_t i = 0; i < worlds[0].size(); ++i) {
      const double apart = mean(i) - o.mean(i), variance_of_both = variance(i) + o.variance(i);
      if (apart == 0 && variance_of_both == 0) continue;
      sum += apart * apart / variance_of_both;
      ++cells;
    }
    return cells ? std::sqrt(sum / cells) : 0;
  }
};

class Symmetry : public test::OnBackend {
 protected:
  static constexpr int steps = 20, seeds = 8;

  void expect_symmetry_under_shifts_by_the_coarsest_tile(const std::string& scheme);

  /// Noise is the same whatever the seed, which is that of the dice.
  static std::string yaml(std::string world, const char* boundary, double direction, int seed) {
    const std::string noise = "noise: {";
    int layers = 0;
    for (auto at = world.find(noise); at != std::string::npos; at = world.find(noise, at + 1))
      world.insert(at + noise.size(), "seed: " + std::to_string(100 + layers++ - seed) + ", ");
    return "grid: {width: 40, height: 40, boundary: " + std::string(boundary) + "}\n" + world +
           "seed: " + std::to_string(seed) +
           "\nwind: {warping: false, projection: false, speed: 5, direction_deg: " +
           std::to_string(direction) + "}\n";
  }

  /// The layers of a world after all steps, by number of the layer; those that it does not have are empty.
  using Layers = std::vector<std::vector<std::uint32_t>>;

  static Layers layers_of(const Simulation& s) {
    Layers layers;
    for (Layer layer : moved_layers)
      layers.push_back(s.terrain().has(layer) ? s.terrain().raw_words(layer) : std::vector<std::uint32_t>());
    return layers;
  }

  /// The start of `world` with seed 1, moved, with the dice of `seed`.
  Layers run(const std::string& world, const char* boundary, double direction, const Motion* motion,
             int seed) {
    const auto first = simulation(yaml(world, boundary, direction, 1));
    const auto s = simulation(yaml(world, boundary, motion ? motion->turn(direction) : direction, seed));
    // The winds themselves must be mirror images, or the test would ask too much.
    const wind::Vector a = first->state().wind_above(), b = s->state().wind_above();
    if (std::abs(a.x) != std::abs(b.x) && std::abs(a.x) != std::abs(b.y))
      ADD_FAILURE() << "choose another direction";
    const Layers start = layers_of(*first);
    Terrain& terrain = const_cast<Terrain&>(s->terrain());
    for (std::size_t l = 0; l < moved_layers.size(); ++l)
      if (!start[l].empty())
        terrain.set_raw_words(moved_layers[l], motion ? moved(start[l], *motion) : start[l]);
    test::run(*s, steps);
    return layers_of(*s);
  }

  /// `act`: what is compared for a motion.
  template <class Act>
  static void for_each_motion(const char* boundary, double direction, const Act& act) {
    for (const Motion& m : motions()) {
      if (std::string(boundary) == "open" && m.name.rfind("shifted", 0) == 0) continue;
      SCOPED_TRACE(m.name + ", " + boundary + ", wind to " + std::to_string(direction) + " degrees");
      act(m);
    }
  }

  void expect_equivariant(const std::string& world, const char* boundary = "periodic", double direction = 30,
                          long long tolerance = 0) {
    const Layers plain = run(world, boundary, direction, nullptr, 1);
    for_each_motion(boundary, direction, [&](const Motion& m) {
      const Layers found = run(world, boundary, direction, &m, 1);
      for (std::size_t l = 0; l < plain.size(); ++l) {
        if (plain[l].empty()) continue;
        const auto expected = moved(plain[l], m);
        long long largest = 0;
        for (std::size_t i = 0; i < expected.size(); ++i)
          largest = std::max(largest, std::abs(difference(moved_layers[l], expected[i], found[l][i])));
        EXPECT_LE(largest, tolerance) << "quanta of " << info(moved_layers[l]).name;
      }
    });
  }

  /// Cell by cell the means of moved worlds and of plain ones, of other seeds, differ as those of two samples
  /// of one distribution do: by three standard errors at most, root mean square over the cells. Chance alone
  /// makes up to 2.5 of them, because neighbours scatter together; with six times as many seeds it makes no
  /// more, while a bias would grow with the square root of their number.
  void expect_same_on_average(const std::string& world, const char* boundary = "periodic",
                              double direction = 30) {
    std::vector<Layers> plain;
    for (int seed = 1; seed <= seeds; ++seed) plain.push_back(run(world, boundary, direction, nullptr, seed));
    for_each_motion(boundary, direction, [&](const Motion& m) {
      std::vector<Layers> found;
      for (int seed = 1; seed <= seeds; ++seed)
        found.push_back(run(world, boundary, direction, &m, seeds + seed));
      for (std::size_t l = 0; l < moved_layers.size(); ++l) {
        if (plain[0][l].empty()) continue;
        Sample expected, others;
        for (const Layers& layers : plain) expected.add(moved_layers[l], moved(layers[l], m));
        for (const Layers& layers : found) others.add(moved_layers[l], layers[l]);
        EXPECT_LE(expected.standard_errors_to(others), 3) << info(moved_layers[l]).name;
      }
    });
  }
};

TEST_P(Symmetry, OfSaltationAlone) {
  expect_equivariant(deep + no_avalanches + "wind_shadow: {enabled: false}\nreptation: {method: 'off'}\n");
}
TEST_P(Symmetry, OfWindShadow) {
  expect_equivariant(deep + no_avalanches + faint);
  expect_same_on_average(patchy + no_avalanches);
}
TEST_P(Symmetry, OfWindShadowAtSixtyDegrees) {
  expect_equivariant(deep + no_avalanches + faint, "periodic", 60);
  expect_same_on_average(patchy + no_avalanches, "periodic", 60);
}
TEST_P(Symmetry, OfWindShadowAlongTheAxis) {
  expect_equivariant(deep + no_avalanches + faint, "periodic", 0);
  expect_same_on_average(patchy + no_avalanches, "periodic", 0);
}
TEST_P(Symmetry, OfCurvedWindShadow) {
  expect_equivariant(deep + no_avalanches + faint_curved);
  expect_same_on_average(patchy + no_avalanches + "wind_shadow: {curved: true}\n");
}
TEST_P(Symmetry, OfCurvedWindShadowAtSixtyDegrees) {
  expect_equivariant(deep + no_avalanches + faint_curved, "periodic", 60);
  expect_same_on_average(patchy + no_avalanches + "wind_shadow: {curved: true}\n", "periodic", 60);
}
TEST_P(Symmetry, OfAdaptiveRepose) {
  expect_equivariant(deep + faint + sweeps);
  expect_same_on_average(patchy + sweeps);
}
TEST_P(Symmetry, OfSmoothing) {
  const std::string smoothing = "reptation: {method: smoothing, strength: 0.5}\n";
  expect_equivariant(deep + faint + sweeps + smoothing, "periodic", 30, small_share_of_relief);
  expect_same_on_average(patchy + sweeps + smoothing);
}
TEST_P(Symmetry, OfTaylorKeyser) {
  const std::string taylor_keyser = "avalanching: {scheme: taylor_keyser, sweeps: 10}\n";
  expect_equivariant(deep + faint + taylor_keyser);
  expect_same_on_average(patchy + taylor_keyser);
}
TEST_P(Symmetry, OfConvergedSweeps) {
  const std::string converged =
      "avalanching: {scheme: sweeps, quality: converged, sweeps: 5, max_iterations: 20}\n";
  expect_equivariant(deep + faint + converged);
  expect_same_on_average(patchy + converged);
}
TEST_P(Symmetry, OfAbrasionSoilAndBedrock) {
  const std::string ground =
      "  - noise: {layer: soil, low: 0, high: 3, scale: 14, threshold: 0.5}\n"
      "  - noise: {layer: erosion_resistance, low: 0, high: 0.9, scale: 14}\n"
      "  - cone: {layer: bedrock, x: 13, y: 21, radius: 5, height: 20}\n";
  const std::string abrasion = "abrasion: {rate: 0.02, cover: 0.5}\n";
  expect_equivariant(deep + ground + faint + "abrasion: {rate: 0.02, cover: 9}\n" + sweeps);
  expect_same_on_average(patchy + ground + abrasion + sweeps);
}
TEST_P(Symmetry, OfVegetationAndMoisture) {
  const auto wet = [](const std::string& most) {
    return "  - noise: {layer: vegetation, low: 0, high: 0.9, scale: 14, threshold: 0.4}\n"
           "  - noise: {layer: moisture, low: 0, high: " +
           most + ", scale: 14, threshold: 0.5}\n";
  };
  expect_equivariant(deep + wet("0.02") + faint + sweeps);
  expect_same_on_average(patchy + wet("0.3") + sweeps);
}
TEST_P(Symmetry, OfObstacles) {
  const std::string obstacle =
      "  - obstacle: {x: 12, y: 25, size_x: 9, size_y: 5, angle_deg: 20, height: 6}\n";
  expect_equivariant(deep + obstacle + faint + sweeps);
  expect_same_on_average(patchy + obstacle + sweeps);
}
TEST_P(Symmetry, OfEchoDunes) {
  expect_equivariant(deep + cliff + faint + sweeps);
  expect_same_on_average(patchy + cliff + sweeps);
}
TEST_P(Symmetry, OfEchoDunesAtSixtyDegrees) {
  expect_equivariant(deep + cliff + faint + sweeps, "periodic", 60);
  expect_same_on_average(patchy + cliff + sweeps, "periodic", 60);
}
TEST_P(Symmetry, OfOpenEdgesWithInflux) {
  const std::string influx = "saltation: {influx: 0.3}\n";
  expect_equivariant(deep + faint + sweeps + influx, "open");
  expect_same_on_average(patchy + sweeps + influx, "open");
}

/// Closed tiles: shifts by the widest tile are exact, whatever the levels.
void Symmetry::expect_symmetry_under_shifts_by_the_coarsest_tile(const std::string& scheme) {
  const std::string text =
      "grid: {width: 256, height: 256, cell_size: 1}\n"
      "terrain: [noise: {layer: bedrock, low: 0, high: 12, scale: 50}, noise: {layer: sand, low: 3, high: 9, "
      "scale: 40, seed: 2}]\n"
      "wind: {warping: false, projection: false, speed: 6, direction_deg: 30}\n"
      "wind_shadow: {enabled: false}\navalanching: {coarsest_cell: 4, scheme: " +
      scheme + "}\n";
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

TEST_P(Symmetry, OfMultilevelUnderShiftsByTheCoarsestTile) {
  expect_symmetry_under_shifts_by_the_coarsest_tile("multilevel");
}

TEST_P(Symmetry, OfGradientUnderShiftsByTheCoarsestTile) {
  expect_symmetry_under_shifts_by_the_coarsest_tile("gradient");
}

DESERT_ON_EACH_BACKEND(Symmetry);

}  // namespace
}  // namespace desert_sim
