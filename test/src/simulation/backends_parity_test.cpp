// CPU against CUDA: bit for bit, with the transforms of wind and stress and without them.

#include <algorithm>
#include <cctype>

#include "src/simulation/checkpoint.hpp"
#include "src/simulation/processes/sand_slopes.hpp"
#include "test/support/bench_terrain.hpp"
#include "test/support/cases.hpp"
#include "test/support/edits.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

class Parity : public test::OnBoth {
 protected:
  /// Number of words that differ, by layer; fails with its name and the first cell.
  static void expect_same_layers(const Simulation& a, const Simulation& b, bool derived) {
    for (const LayerInfo& row : layer_table) {
      if ((row.lifetime != Lifetime::persistent && row.lifetime != Lifetime::on_request && !derived) ||
          !a.terrain().has(row.layer))
        continue;
      const auto x = a.terrain().raw_words(row.layer), y = b.terrain().raw_words(row.layer);
      long different = 0;
      std::size_t first = 0;
      for (std::size_t i = x.size(); i-- > 0;)
        if (x[i] != y[i]) ++different, first = i;
      EXPECT_EQ(different, 0) << "cells of " << row.name << ", first (" << first % a.terrain().grid().width
                              << ", " << first / a.terrain().grid().width << ")";
    }
  }

  void expect_bit_for_bit(const std::string& yaml, int steps) {
    auto a = test::simulate(cpu(), yaml), b = test::simulate(cuda(), yaml);
    EXPECT_EQ(a->state().hash(), b->state().hash()) << "before the first step";
    for (int n = 1; n <= steps; ++n) {
      a->step();
      b->step();
      if (n > 2 && n % 10 != 0 && n != steps) continue;
      expect_same_layers(*a, *b, true);
      EXPECT_EQ(a->state().hash(), b->state().hash()) << "after step " << n;
      if (HasFailure()) return;
    }
    test::expect_sound(*b, "on the GPU");
    EXPECT_EQ(a->pipeline().mean_count(avalanche_iterations), b->pipeline().mean_count(avalanche_iterations));
  }
};

/// One test for each group of cases, so that a sanitizer can take them one at a time.
class ParityOf : public Parity, public ::testing::WithParamInterface<int> {};

TEST_P(ParityOf, CaseIsBitForBitOverFiftySteps) {
  const test::Case c = test::process_cases(true)[static_cast<std::size_t>(GetParam())];
  SCOPED_TRACE(c.name);
  expect_bit_for_bit(test::grid_yaml(64, 48, "periodic") + c.yaml, 50);
  expect_bit_for_bit(test::grid_yaml(37, 41, "open") + c.yaml, 20);
}

/// A GPU divides long lines among blocks that repeat each other's work where they meet.
TEST_F(Parity, SweepsOverLongLinesAreBitForBit) {
  const std::vector<test::Case> cases = test::process_cases(true);
  const auto continuum =
      std::find_if(cases.begin(), cases.end(), [](const test::Case& c) { return c.name == "continuum"; });
  ASSERT_NE(continuum, cases.end());
  for (const char* boundary : {"periodic", "open"})
    for (const auto& [width, height] : {std::pair{1100, 45}, std::pair{70, 513}})
      for (const int degrees : {20, 95, 230}) {
        SCOPED_TRACE(testing::Message() << width << " x " << height << ", " << boundary << ", " << degrees);
        std::string yaml = test::grid_yaml(width, height, boundary) + continuum->yaml;
        const std::string wind = "direction_deg: 127";
        ASSERT_NE(yaml.find(wind), std::string::npos);
        yaml.replace(yaml.find(wind), wind.size(), "direction_deg: " + std::to_string(degrees));
        expect_bit_for_bit(yaml, 3);
      }
}

std::string case_name(const ::testing::TestParamInfo<int>& info) {
  std::string name = test::process_cases(true)[static_cast<std::size_t>(info.param)].name;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, ParityOf,
                         ::testing::Range(0, static_cast<int>(test::process_cases(true).size())), case_name);

/// Little enough work for a race checker.
TEST_F(Parity, OfASingleStep) {
  for (const test::Case& c : test::process_cases(true)) {
    SCOPED_TRACE(c.name);
    auto s = test::simulate(cuda(), test::grid_yaml(40, 36, "open") + c.yaml);
    s->step();
    test::expect_sound(*s, "on the GPU");
  }
}

TEST_F(Parity, OfTinyGrids) {
  const std::string yaml = test::process_cases(true).back().yaml;
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 40}, {40, 1}, {2, 3}, {33, 5}})
    for (const char* boundary : {"periodic", "open"})
      expect_bit_for_bit(test::grid_yaml(width, height, boundary) + yaml, 10);
}

TEST_F(Parity, OfSeveralLevels) {
  expect_bit_for_bit(test::grid_yaml(150, 133, "periodic") +
                         "terrain: [noise: {layer: bedrock, low: 0, high: 20, scale: 40}, noise: {layer: "
                         "sand, low: 0, high: 12, scale: 30, seed: 2}]\n"
                         "wind: {speed: 6, direction_deg: 77}\navalanching: {coarsest_cell: 8}\n",
                     20);
}

/// Slope, normal, roughness, steps and traversability, over wide windows too.
TEST_F(Parity, OfTraversability) {
  std::vector<Layer> layers;
  for (const LayerInfo& row : layer_table)
    if (row.lifetime == Lifetime::on_request) layers.push_back(row.layer);
  for (const test::Case& c : test::process_cases(true))
    for (const char* window : {"0", "3.5", "100"}) {
      SCOPED_TRACE(c.name + ", window " + window);
      const std::string yaml = c.yaml + "traversability: {window: " + window + "}\n";
      for (const char* boundary : {"periodic", "open"}) {
        auto a = test::simulate(cpu(), test::grid_yaml(37, 41, boundary) + yaml);
        auto b = test::simulate(cuda(), test::grid_yaml(37, 41, boundary) + yaml);
        for (int step = 0; step < 2; ++step) {  // the second one with water that flows
          const auto x = a->views().snapshot(layers), y = b->views().snapshot(layers);
          for (Layer layer : layers)
            EXPECT_TRUE(x->layers.at(layer) == y->layers.at(layer))
                << info(layer).name << ", " << boundary << ", step " << step;
          a->step();
          b->step();
        }
      }
    }
}

TEST_F(Parity, OfEdits) {
  const std::string yaml =
      test::grid_yaml(40, 30, "periodic") +
      "terrain: [noise: {layer: bedrock, low: 0, high: 5, scale: 9}, uniform: {layer: sand, value: 3}]\n"
      "wind: {speed: 6}\n";
  auto a = test::simulate(cpu(), yaml), b = test::simulate(cuda(), yaml);
  for (int n = 0; n < 12; ++n) {
    command::EditTerrain edit;
    edit.layer = n % 4 == 3 ? "bedrock" : "sand";
    edit.merge = static_cast<BrushMerge>(n % 6);
    edit.shape = n % 2 ? BrushShape::ellipse : BrushShape::circle;
    edit.x = 4.7 * n;
    edit.y = 31 - 2.3 * n;
    edit.radius = 2 + 0.9 * n;
    edit.radius_y = 3.3;
    edit.angle_deg = 31 * n;
    edit.inner = 0.25;
    edit.value = 7.7;
    const CommandResult x = a->apply(edit), y = b->apply(edit);
    EXPECT_EQ(x.volume_m3, y.volume_m3);
    a->step();
    b->step();
    expect_same_layers(*a, *b, true);
  }
}

TEST_F(Parity, OfEveryShapeMergeAndRing) {
  const std::string yaml = test::edit_world(
      "periodic", ", noise: {layer: sand, low: 1, high: 4, scale: 2}, uniform: {layer: soil, value: 1}");
  auto a = test::simulate(cpu(), yaml), b = test::simulate(cuda(), yaml);
  int n = 0;
  for (command::EditTerrain edit : test::one_of_each_shape())
    for (int merge = 0; merge < static_cast<int>(std::size(brush_merges)); ++merge) {
      edit.merge = static_cast<BrushMerge>(merge);
      edit.layer = n % 3 == 0 ? "soil" : "sand";
      edit.value = 0.41;
      edit.conserve = ++n % 2 == 0;
      edit.smooth_passes = 3;
      edit = test::shifted(edit, 0.7, -0.3);  // over the borders, in time
      const CommandResult x = a->apply(edit, true), y = b->apply(edit, true);
      EXPECT_EQ(x.volume_m3, y.volume_m3);
      EXPECT_EQ(x.moved_m3, y.moved_m3);
      EXPECT_EQ(x.changes.at(0).values, y.changes.at(0).values);
      expect_same_layers(*a, *b, false);
    }
}

TEST_F(Parity, StatisticsAgree) {
  const std::string yaml = test::grid_yaml(70, 50, "open") + test::process_cases(true).back().yaml;
  auto a = test::simulate(cpu(), yaml), b = test::simulate(cuda(), yaml);
  test::run(*a, 5);
  test::run(*b, 5);
  const auto x = a->state().balance(), y = b->state().balance();
  for (std::size_t m = 0; m < x.size(); ++m) {
    EXPECT_EQ(x[m].final, y[m].final);
    EXPECT_EQ(x[m].in, y[m].in);
    EXPECT_EQ(x[m].out, y[m].out);
  }
  const Residual r = sand_residual(a->state(), a->pipeline()), q = sand_residual(b->state(), b->pipeline());
  EXPECT_EQ(r.share_over_1e3, q.share_over_1e3);
  EXPECT_EQ(r.share_over_1e2, q.share_over_1e2);
  EXPECT_EQ(r.mean_excess, q.mean_excess);
  EXPECT_EQ(r.largest_excess, q.largest_excess);
  EXPECT_EQ(max_sand_slope_deg(a->state()), max_sand_slope_deg(b->state()));
}

TEST_F(Parity, CheckpointsGoFromOneToTheOther) {
  const test::TemporaryFolder folder;
  const std::string yaml = test::grid_yaml(45, 33, "open") + test::process_cases(true).back().yaml;
  auto a = test::simulate(cpu(), yaml);
  test::run(*a, 5);
  save_checkpoint(folder.path("a.ck"), *a);
  auto b = load_checkpoint(folder.path("a.ck"), cuda());
  EXPECT_EQ(a->state().hash(), b->state().hash());
  test::run(*a, 5);
  test::run(*b, 5);
  EXPECT_EQ(a->state().hash(), b->state().hash());
}

/// The grid of the wind: in one kernel, longer than that one takes, of lengths with large prime factors, at
/// full resolution, with the largest number of radii; that of the stress: the terrain's own and coarser.
TEST_F(Parity, OfTransformsOfEveryLength) {
  const std::string terrain =
      "terrain: [noise: {layer: bedrock, low: 0, high: 10, scale: 30}, noise: {layer: sand, low: 0.5, high: "
      "4, scale: 12}]\n";
  const std::string wind = "wind: {speed: 5, direction_deg: 20, radii: [60, 20], coarsening: ";
  struct Size {
    int width, height;
  };
  for (const char* boundary : {"periodic", "open"}) {
    SCOPED_TRACE(boundary);
    for (const Size& size : {Size{128, 96}, Size{301, 97}, Size{600, 40}, Size{1021, 34}, Size{36, 2039}})
      for (const char* coarsening : {"0", "1", "3"}) {
        SCOPED_TRACE(testing::Message() << size.width << " x " << size.height << ", " << coarsening);
        expect_bit_for_bit(test::grid_yaml(size.width, size.height, boundary) + terrain + wind + coarsening +
                               "}\nreptation: {method: smoothing}\n",
                           3);
      }
    for (const Size& size : {Size{128, 96}, Size{301, 97}, Size{45, 1021}})
      for (const char* cell : {"0.1", "3"}) {
        SCOPED_TRACE(testing::Message() << size.width << " x " << size.height << ", stress " << cell);
        expect_bit_for_bit(test::grid_yaml(size.width, size.height, boundary) + terrain +
                               "wind: {speed: 9, direction_deg: 20}\nsand: {model: continuum}\nshear_stress: "
                               "{stress_cell: " +
                               cell + "}\n",
                           3);
      }
  }
}

TEST_F(Parity, CudaGivesTheSameHashTwice) {
  for (const test::Case& c : test::process_cases(true)) {
    SCOPED_TRACE(c.name);
    std::uint64_t hashes[2];
    for (std::uint64_t& hash : hashes) {
      auto s = test::simulate(cuda(), test::grid_yaml(70, 50, "open") + c.yaml);
      test::run(*s, 5);
      hash = s->state().hash();
    }
    EXPECT_EQ(hashes[0], hashes[1]);
  }
}

}  // namespace
}  // namespace desert_sim
