// The shipped scenarios make the landforms that they are named for, and keep their material to the last
// quantum. Bounds are published figures, unless a comment says otherwise.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "test/support/running.hpp"

namespace desert_sim {
namespace {

const Settings small{"grid.width=192", "grid.height=192"};

double mean_where(const Field& values, const std::vector<char>& mask) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (mask[i]) sum += values.values[i], ++count;
  return count ? sum / static_cast<double>(count) : 0;
}

// ---- barchans: one test a seed, and one of the barchans of all seeds ----

constexpr std::uint64_t barchan_seeds = 8;

/// The barchans of five looks at the shipped scenario, from 360 to 520 steps. The grid is narrower than the
/// scenario's but longer along the wind, because dunes are steeper where the periodic border is near upwind:
/// the mean stoss slope of 24 seeds is 16.2 degrees on 256 x 256 cells, 14.9 on the scenario's 384 x 384, and
/// 12.8 on 768 x 128, which are two thirds as many.
/// Dunes are cut apart at 1.5 m, so that the thin sand between their horns does not join them.
std::vector<DuneShape> run_barchans(std::uint64_t seed) {
  Running scene(shipped("barchan", {"seed=" + std::to_string(seed), "grid.width=768", "grid.height=128"}));
  std::vector<DuneShape> found;
  scene.run(320);
  for (int look = 0; look < 5; ++look) {
    scene.run(40);
    for (const DuneShape& d :
         find_dunes(scene.field(Layer::elevation), scene.field(Layer::sand), 0, 1.5, 100))
      if (d.height >= 3.5) found.push_back(d);
  }
  scene.expect_balanced();
  return found;
}

/// The run of a seed, which begins with the first call; a process runs each seed once.
std::shared_future<std::vector<DuneShape>> barchans(std::uint64_t seed) {
  static std::mutex mutex;
  static std::map<std::uint64_t, std::shared_future<std::vector<DuneShape>>> runs;
  const std::lock_guard<std::mutex> lock(mutex);
  std::shared_future<std::vector<DuneShape>>& run = runs[seed];
  if (!run.valid()) run = std::async(std::launch::async, run_barchans, seed).share();
  return run;
}

/// ctest runs each test in a process of its own: there the test of a seed writes its barchans to a file of
/// the folder DESERT_BARCHANS, and the test of all seeds reads them. Empty without DESERT_BARCHANS.
std::string barchan_file(std::uint64_t seed) {
  const char* folder = std::getenv("DESERT_BARCHANS");
  return folder ? folder + ("/" + std::to_string(seed)) : "";
}

void write_barchans(const std::string& path, const std::vector<DuneShape>& dunes) {
  std::ofstream file(path);
  file.precision(std::numeric_limits<double>::max_digits10);
  for (const DuneShape& d : dunes)
    file << d.height << ' ' << d.width << ' ' << d.stoss_deg << ' ' << d.slip_face_deg << ' '
         << d.slip_direction_deg << ' ' << d.horn_direction_deg << ' ' << d.horn_reach << '\n';
  ASSERT_TRUE(file.flush()) << path;
}

std::vector<DuneShape> read_barchans(std::ifstream& file) {
  std::vector<DuneShape> dunes;
  for (DuneShape d; file >> d.height >> d.width >> d.stoss_deg >> d.slip_face_deg >> d.slip_direction_deg >>
                    d.horn_direction_deg >> d.horn_reach;)
    dunes.push_back(d);
  return dunes;
}

/// Medians over dunes, unless they say else; directions are angles from downwind.
struct BarchanShape {
  double height_to_width;
  double stoss_deg;  ///< mean, which scatters less from seed to seed than the median
  double slip_face_deg, slip_direction_deg, horn_direction_deg;
  double horns_downwind;  ///< share of the dunes whose two horns reach beyond their middle
};

BarchanShape shape_of(const std::vector<DuneShape>& dunes) {
  std::vector<double> ratio, slip, direction, horns;
  const auto count = static_cast<double>(dunes.size());
  double stoss = 0, downwind = 0;
  for (const DuneShape& d : dunes) {
    ratio.push_back(d.height / d.width);
    stoss += d.stoss_deg / count;
    slip.push_back(d.slip_face_deg);
    direction.push_back(angle_between_deg(d.slip_direction_deg, 0));
    horns.push_back(angle_between_deg(d.horn_direction_deg, 0));
    downwind += d.horn_reach > 0 ? 1 / count : 0;
  }
  const BarchanShape s{quantile(ratio, 0.5), stoss,   quantile(slip, 0.5), quantile(direction, 0.5),
                       quantile(horns, 0.5), downwind};
  DESERT_REPORT(
      "%zu barchans: h/w %.3f, stoss %.1f, slip face %.1f, to within %.0f of downwind, horns %.0f; %.0f %% "
      "reach out",
      dunes.size(), s.height_to_width, s.stoss_deg, s.slip_face_deg, s.slip_direction_deg,
      s.horn_direction_deg, 100 * s.horns_downwind);
  return s;
}

class Barchans : public ::testing::TestWithParam<std::uint64_t> {};

/// Bounds are wide, because the five looks at a seed find 5 to 22 dunes: seeds 1 to 48 have a height to width
/// of 0.049…0.193, stoss 8.4…16.1 degrees, slip face 33.0…34.6 degrees to within 1…36 degrees of downwind,
/// horns to within 1…23 degrees, and both horns downwind in 0…100 %, of which so few dunes tell nothing.
TEST_P(Barchans, OfOneSeed) {
  const std::string file = barchan_file(GetParam());
  if (!file.empty()) std::filesystem::remove(file);
  const std::vector<DuneShape> dunes = barchans(GetParam()).get();
  ASSERT_GE(dunes.size(), 3u);
  const BarchanShape s = shape_of(dunes);
  EXPECT_GE(s.height_to_width, 0.03);
  EXPECT_LE(s.height_to_width, 0.22);
  EXPECT_GE(s.stoss_deg, 5);
  EXPECT_LE(s.stoss_deg, 20);
  EXPECT_GE(s.slip_face_deg, 31);
  EXPECT_LE(s.slip_face_deg, 35);
  EXPECT_LE(s.slip_direction_deg, 60);
  EXPECT_LE(s.horn_direction_deg, 30);
  if (!file.empty()) write_barchans(file, dunes);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Barchans, ::testing::Range<std::uint64_t>(1, barchan_seeds + 1),
                         [](const auto& test) { return std::to_string(test.param); });

/// Published: height to width 0.06…0.15, stoss 8…15 degrees, slip face 31…35 degrees to within 20 degrees of
/// downwind, horns downwind. The bounds are narrower, as far as the scatter between sets of 8 seeds allows:
/// seeds 1 to 96 have a height to width of 0.121 (standard deviation of sets of 8, from those of 12: 0.013),
/// stoss 13.1 (0.66), slip face 33.0 (0.01) to within 8.7 (2.0) of downwind, horns to within 3.4 (0.7), and
/// both horns downwind in 73 % (7 %). Seeds 1 to 8 have 0.134, 12.8, 33.3, 12, 3 and 65 %.
TEST(Dunes, Barchan) {
  std::vector<DuneShape> dunes;
  std::vector<std::shared_future<std::vector<DuneShape>>> runs;
  for (std::uint64_t seed = 1; seed <= barchan_seeds; ++seed) {
    std::ifstream file(barchan_file(seed));
    if (!file) {
      runs.push_back(barchans(seed));
      continue;
    }
    for (const DuneShape& d : read_barchans(file)) dunes.push_back(d);
  }
  for (const auto& run : runs) dunes.insert(dunes.end(), run.get().begin(), run.get().end());
  ASSERT_GE(dunes.size(), 50u);
  const BarchanShape s = shape_of(dunes);
  EXPECT_GE(s.height_to_width, 0.085);
  EXPECT_LE(s.height_to_width, 0.15);
  EXPECT_GE(s.stoss_deg, 11.6);
  EXPECT_LE(s.stoss_deg, 14.6);
  EXPECT_GE(s.slip_face_deg, 32.5);
  EXPECT_LE(s.slip_face_deg, 35);
  EXPECT_LE(s.slip_direction_deg, 18);
  EXPECT_LE(s.horn_direction_deg, 10);
  EXPECT_GE(s.horns_downwind, 0.45);
}

// ---- other landforms ----

/// Crests within 20 degrees of perpendicular to the wind; the distance between them grows. The grid is long
/// along the wind, because 192 m hold three dunes, whose distance is often not to be told; it scatters by a
/// fifth from seed to seed, so that its growth is that of means.
TEST(Dunes, Transverse) {
  double early = 0, late = 0;
  constexpr int seeds = 4;
  for (int seed = 1; seed <= seeds; ++seed) {
    Running scene(
        shipped("transverse", {"seed=" + std::to_string(seed), "grid.width=384", "grid.height=96"}));
    const std::optional<double> before = wavelength(scene.run(40).field(Layer::elevation), 0);
    const Field elevation = scene.run(560).field(Layer::elevation);
    const std::optional<double> after = wavelength(elevation, 0);
    ASSERT_TRUE(before && after) << "seed " << seed << ": no distance between crests";
    const Orientation o = crest_orientation(elevation, 2);
    DESERT_REPORT("seed %d: crests at %.1f degrees (coherence %.2f), wavelength %.1f then %.1f m", seed,
                  o.crest_deg, o.coherence, *before, *after);
    EXPECT_LT(line_angle_between_deg(o.crest_deg, 90), 20) << "seed " << seed;
    EXPECT_GT(o.coherence, 0.5) << "seed " << seed;
    early += *before / seeds;
    late += *after / seeds;
    scene.expect_balanced();
  }
  DESERT_REPORT("mean wavelength %.1f then %.1f m", early, late);
  EXPECT_GT(late, 1.5 * early);
}

/// Crests along the resultant of two winds more than 90 degrees apart.
TEST(Dunes, Linear) {
  Running scene(shipped("linear", small));
  const Orientation o = crest_orientation(scene.run(500).field(Layer::elevation), 4);
  DESERT_REPORT("crests at %.1f degrees (coherence %.2f)", o.crest_deg, o.coherence);
  EXPECT_LT(line_angle_between_deg(o.crest_deg, 0), 15);
  EXPECT_GT(o.coherence, 0.5);
  scene.expect_balanced();
}

/// Slip faces to at least three sides at one time.
TEST(Dunes, Star) {
  Running scene(shipped("star", small));
  std::vector<double> counts;
  scene.run(300);
  for (int look = 0; look < 4; ++look) {
    // One look in each of the four winds.
    const std::vector<double> directions = slip_face_directions(scene.run(60).field(Layer::elevation));
    counts.push_back(static_cast<double>(directions.size()));
    std::string text;
    for (double d : directions) text += " " + std::to_string(static_cast<int>(d));
    DESERT_REPORT("slip faces to%s", text.c_str());
  }
  EXPECT_GE(quantile(counts, 0.5), 3);
  scene.expect_balanced();
}

/// Sand lies where the plants are, and its tail downwind of them.
TEST(Dunes, Nebkha) {
  Running scene(shipped("nebkha", small));
  const Field plants = scene.field(Layer::vegetation);
  scene.run(400);
  const Field sand = scene.field(Layer::sand);
  const auto shifted = [&](int cells) {
    std::vector<char> mask(plants.values.size());
    for (int y = 0; y < plants.height; ++y)
      for (int x = 0; x < plants.width; ++x)
        mask[plants.index(x, y)] = plants.at(x - cells, y) > 0 && plants.at(x, y) == 0;
    return mask;
  };
  std::vector<char> planted(plants.values.size());
  for (std::size_t i = 0; i < planted.size(); ++i) planted[i] = plants.values[i] > 0;
  const double all = mean_where(sand, std::vector<char>(planted.size(), 1)), on = mean_where(sand, planted);
  const double lee = mean_where(sand, shifted(8)), upwind = mean_where(sand, shifted(-8));
  DESERT_REPORT("sand: mean %.2f m, among plants %.2f m, 8 m downwind of them %.2f m, upwind %.2f m", all, on,
                lee, upwind);
  EXPECT_GT(on, 3 * all);
  EXPECT_GT(lee, 1.3 * upwind);
  scene.expect_balanced();
}

/// Bushes that came up by themselves hold sand, with tails downwind.
TEST(Dunes, LivingNebkha) {
  Running scene(shipped("nebkha_live", small));
  scene.run(400);
  const Field sand = scene.field(Layer::sand);
  const plants::Workspace& bushes = scene.simulation().state().plants;
  const std::vector<std::uint32_t> words = plants::words(bushes);
  const auto count = static_cast<std::size_t>(bushes.count);
  ASSERT_GT(count, 10u);
  double on = 0, lee = 0, upwind = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const int x = static_cast<int>(float_from_bits(words[n])),
              y = static_cast<int>(float_from_bits(words[count + n]));
    on += sand.at(x, y) / static_cast<double>(count);
    for (int away = 6; away <= 10; ++away) {
      lee += sand.at(x + away, y) / (5.0 * static_cast<double>(count));
      upwind += sand.at(x - away, y) / (5.0 * static_cast<double>(count));
    }
  }
  const double all = mean_where(sand, std::vector<char>(sand.values.size(), 1));
  DESERT_REPORT(
      "%zu bushes; sand: mean %.2f m, under them %.2f m, 6 to 10 m downwind of them %.2f m, upwind %.2f m",
      count, all, on, lee, upwind);
  EXPECT_GT(on, 2 * all);
  EXPECT_GT(lee, 1.3 * upwind);
  scene.expect_balanced();
}

/// A dune in front of the tower, off it by a lane of 0.3 to 1 of the tower's height.
TEST(Dunes, Echo) {
  constexpr double tower = 15;
  Running scene(shipped("echo_dune", {"grid.width=320", "grid.height=96"}));
  const Field wall = scene.field(Layer::obstacle);
  scene.run(400);
  const WallFront front = wall_front(scene.field(Layer::sand), wall, 45, 52, 0.3, 3 * tower);
  DESERT_REPORT("lane %.1f m (%.2f of the tower), dune %.1f m high, %.1f m before it", front.lane,
                front.lane / tower, front.dune_height, front.dune_distance);
  EXPECT_GE(front.lane, 0.3 * tower);
  EXPECT_LE(front.lane, 1.0 * tower);
  EXPECT_GT(front.dune_height, 1.5);
  EXPECT_LT(front.dune_distance, 2.0 * tower);
  scene.expect_balanced();
}

/// Ridges of rock within 10 degrees of the wind, whichever way it blows over rock that varies alike in all
/// directions.
TEST(Dunes, Yardang) {
  for (double turn : {0.0, 35.0}) {
    Settings settings = small;
    settings.insert(settings.end(), {"terrain.1.noise.stretch=1", "terrain.1.noise.scale=20"});
    const double directions[] = {-4, 0, 4, -4, 4};
    for (int n = 0; n < 5; ++n)
      settings.push_back("wind.segments." + std::to_string(n) +
                         ".direction_deg=" + std::to_string(turn + directions[n]));
    Running scene(shipped("yardang", settings));
    const Orientation before = crest_orientation(scene.field(Layer::bedrock), 2);
    const Orientation o = crest_orientation(scene.run(400).field(Layer::bedrock), 2);
    DESERT_REPORT("wind to %.0f: ridges at %.1f degrees (coherence %.2f, before %.2f)", turn, o.crest_deg,
                  o.coherence, before.coherence);
    EXPECT_LT(line_angle_between_deg(o.crest_deg, turn), 10);
    EXPECT_GT(o.coherence, 0.25);
    EXPECT_LT(before.coherence, 0.15);
    scene.expect_balanced();
  }
}

}  // namespace
}  // namespace desert_sim
