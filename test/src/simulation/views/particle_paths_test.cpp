// The ways of flying grains: they begin and end on the ground, go with the wind, and change nothing.

#include <algorithm>
#include <cmath>

#include "test/support/world.hpp"

namespace desert_sim {
namespace {

constexpr double cell = 0.01;

std::string ripples(double speed, double direction_deg) {
  return "grid: {width: 64, height: 48, cell_size: 0.01, boundary: periodic}\n"
         "terrain: [{uniform: {layer: bedrock, value: 0}},\n"
         "          {noise: {layer: sand, low: 0.049, high: 0.051, scale: 0.05}}]\n"
         "sand: {model: wang}\nrun: {time_step: 1 s}\nwind: {speed: " +
         std::to_string(speed) + ", direction_deg: " + std::to_string(direction_deg) + "}\n";
}

class ParticlePathsOfGrains : public test::OnBackend {
 protected:
  static std::shared_ptr<const ParticlePaths> paths(Simulation& s, int number) {
    return s.views().begin_particle_paths(number).get();
  }
};

/// The height of the surface in the cell of a place, on a periodic terrain.
double ground(const Snapshot& s, const particles::PathPoint& p) {
  const auto along = [](float place, int count) {
    const int n = static_cast<int>(std::floor(static_cast<double>(place) / cell)) % count;
    return static_cast<std::size_t>(n < 0 ? n + count : n);
  };
  return static_cast<double>((*s.find(
      Layer::elevation))[along(p.y, s.height) * static_cast<std::size_t>(s.width) + along(p.x, s.width)]);
}

TEST_P(ParticlePathsOfGrains, BeginAndEndOnTheGroundAndGoWithTheWind) {
  const auto world = simulation(ripples(12, 30));
  test::run(*world, 20);
  const auto all = paths(*world, 200);
  const auto s = world->views().snapshot({Layer::elevation});
  ASSERT_GT(all->paths.size(), 100u);
  EXPECT_LE(all->paths.size(), 200u);
  double east = 0, north = 0, highest = 0;
  int ended = 0;
  for (const auto& path : all->paths) {
    ASSERT_GE(path.size(), 2u);
    EXPECT_NEAR(static_cast<double>(path.front().z), ground(*s, path.front()), 0.002);
    if (path.size() < 400) {  // else it flies on
      EXPECT_NEAR(static_cast<double>(path.back().z), ground(*s, path.back()), 0.002);
      ++ended;
    }
    east += static_cast<double>(path.back().x - path.front().x);
    north += static_cast<double>(path.back().y - path.front().y);
    for (const auto& point : path) highest = std::max(highest, static_cast<double>(point.z) - 0.05);
  }
  EXPECT_GT(ended, static_cast<int>(all->paths.size()) / 2);
  EXPECT_NEAR(std::atan2(north, east) * 180 / 3.14159265358979, 30, 3);
  EXPECT_GT(highest, 0.005) << "they fly";
}

TEST_P(ParticlePathsOfGrains, ChangeNothing) {
  const auto watched = simulation(ripples(12, 0)), other = simulation(ripples(12, 0));
  for (int n = 0; n < 5; ++n) {
    EXPECT_FALSE(paths(*watched, 100)->paths.empty());
    test::run(*watched, 3);
    test::run(*other, 3);
  }
  EXPECT_EQ(watched->state().hash(), other->state().hash());
}

TEST_P(ParticlePathsOfGrains, AreTheSameUntilTheNextStep) {
  const auto world = simulation(ripples(12, 0));
  const auto ends_of_paths = [&] {
    std::vector<float> ends;
    const auto all = paths(*world, 50);
    for (const auto& path : all->paths) ends.push_back(path.back().x);
    return ends;
  };
  const std::vector<float> first = ends_of_paths();
  EXPECT_EQ(ends_of_paths(), first);
  test::run(*world, 1);
  EXPECT_NE(ends_of_paths(), first);
}

TEST_P(ParticlePathsOfGrains, ThereAreNoneWhereNoGrainFlies) {
  EXPECT_TRUE(paths(*simulation(ripples(1, 0)), 50)->paths.empty()) << "below the threshold";
  EXPECT_TRUE(paths(*simulation(ripples(0, 0)), 50)->paths.empty()) << "without wind";
  EXPECT_TRUE(paths(*simulation("grid: {width: 16, height: 16}\n"), 50)->paths.empty()) << "another model";
}

DESERT_ON_EACH_BACKEND(ParticlePathsOfGrains);

}  // namespace
}  // namespace desert_sim
