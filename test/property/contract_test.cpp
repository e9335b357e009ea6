// Each process changes only the layers that its header says it writes.

#include <set>

#include "support/bench_terrain.hpp"
#include "support/world.hpp"

namespace desert_sim {
namespace {

class Contract : public test::OnBackend {
 protected:
  /// A terrain with every layer in use, full of relief.
  std::unique_ptr<test::BenchTerrain> terrain(bool periodic) {
    auto t = std::make_unique<test::BenchTerrain>(exec(), 37, 41, 1.0, periodic);
    const auto wave = [](int x, int y) { return 0.5 + 0.5 * std::sin(0.7 * x + 1.3 * std::cos(0.5 * y)); };
    t->set(Layer::bedrock, [&](int x, int y) { return 20 * wave(x, y) + (x > 20 && y > 20 ? 30 : 0); });
    t->set(Layer::soil, [&](int x, int y) { return x % 3 ? 4 * wave(y, x) : 0; });
    t->set(Layer::sand, [&](int x, int y) { return (x + y) % 4 ? 3 * wave(x + 3, y) : 0; });
    for (Layer layer : {Layer::airborne_sand, Layer::moisture, Layer::suspended_sediment, Layer::humus})
      t->set(layer, [&](int x, int y) { return 0.03 * wave(x, 2 * y); });
    t->set(Layer::water, [&](int x, int y) { return x % 5 ? 0 : 0.1 * wave(x, y); });
    for (Layer layer : {Layer::vegetation, Layer::erosion_resistance, Layer::illumination,
                        Layer::illumination_canopy, Layer::canopy_height})
      t->set(layer, [&](int x, int y) { return x % 4 ? 0 : wave(x, 3 * y); });
    t->set(Layer::obstacle, [&](int x, int y) { return x / 4 == 3 && y / 4 == 2 ? 1 : 0; });
    t->set(Layer::wind_x, [&](int x, int y) { return 4 + wave(x, y); });
    t->set(Layer::wind_y, [&](int x, int y) { return 2 - wave(y, x); });
    t->set(Layer::wind_shadow, [&](int x, int y) { return wave(x, y); });
    t->set(Layer::echo, [&](int x, int y) { return x % 6 ? 0 : wave(x, y) - 0.5; });
    for (Layer layer : {Layer::plants, Layer::water_surface}) t->terrain.require(layer);
    t->set_strength([&](int x, int y) { return wave(x, y); });
    t->set_repose([&](int, int) { return 0.6; });
    t->surface();
    return t;
  }

  template <class Process>
  void expect_only(const char* name, const std::set<Layer>& writes, bool must_change,
                   const Process& process) {
    for (bool periodic : {true, false}) {
      SCOPED_TRACE(std::string(name) + (periodic ? ", periodic" : ", open"));
      auto t = terrain(periodic);
      std::vector<std::vector<std::uint32_t>> before;
      for (const LayerInfo& row : layer_table) before.push_back(t->terrain.words(row.layer));
      process(*t);
      bool changed = false;
      for (const LayerInfo& row : layer_table) {
        const bool same = before[static_cast<std::size_t>(row.layer)] == t->terrain.words(row.layer);
        if (!writes.count(row.layer)) {
          EXPECT_TRUE(same) << "writes " << row.name << ", which its header does not say";
        }
        changed = changed || !same;
      }
      EXPECT_TRUE(changed || !must_change) << "the terrain gives it nothing to do";
    }
  }
};

TEST_P(Contract, OfSurface) {
  expect_only("surface", {Layer::elevation, Layer::sand}, true, [](test::BenchTerrain& t) {
    t.set(Layer::sand, 0);
    t.surface();
  });
  expect_only("surface, again", {}, false, [](test::BenchTerrain& t) { t.surface(); });
}
TEST_P(Contract, OfWind) {
  expect_only("wind", {Layer::wind_x, Layer::wind_y}, true, [](test::BenchTerrain& t) {
    t.blow({}, {5, 2});
  });
}
TEST_P(Contract, OfWindShadow) {
  expect_only("wind_shadow", {Layer::wind_shadow}, true, [](test::BenchTerrain& t) { t.shadow(); });
}
TEST_P(Contract, OfEchoDunes) {
  expect_only("echo_dunes", {Layer::echo}, true, [](test::BenchTerrain& t) { t.echo({}); });
}
TEST_P(Contract, OfTraversability) {
  expect_only("traversability",
              {Layer::slope, Layer::normal_x, Layer::normal_y, Layer::normal_z, Layer::roughness,
               Layer::step_height, Layer::traversability},
              true, [](test::BenchTerrain& t) { t.judge(); });
}
TEST_P(Contract, OfSaltationAndAbrasion) {
  expect_only("saltation", {Layer::sand, Layer::airborne_sand, Layer::bedrock, Layer::soil}, true,
              [](test::BenchTerrain& t) {
                AbrasionParameters a;
                a.rate = 0.05f;
                a.cover = 1;
                SaltationParameters p;
                p.influx = 1;
                t.saltation(p, a);
              });
}
TEST_P(Contract, OfSaltationWithoutAbrasion) {
  expect_only("saltation", {Layer::sand, Layer::airborne_sand}, true,
              [](test::BenchTerrain& t) { t.saltation(); });
}
TEST_P(Contract, OfReptation) {
  for (ReptationMethod method : {ReptationMethod::smoothing, ReptationMethod::steepest})
    expect_only("reptation", {Layer::sand}, true, [method](test::BenchTerrain& t) {
      ReptationParameters p;
      p.method = method;
      t.reptation(p);
    });
  for (ReptationMethod method : {ReptationMethod::off, ReptationMethod::adaptive_repose})
    expect_only("reptation", {}, false, [method](test::BenchTerrain& t) {
      ReptationParameters p;
      p.method = method;
      t.reptation(p);
    });
}
TEST_P(Contract, OfAvalanching) {
  for (AvalancheScheme scheme :
       {AvalancheScheme::multilevel, AvalancheScheme::sweeps, AvalancheScheme::taylor_keyser})
    expect_only("avalanching", {Layer::sand}, true, [scheme](test::BenchTerrain& t) {
      AvalanchingParameters p;
      p.scheme = scheme;
      t.avalanche(p);
    });
}
TEST_P(Contract, OfSoilAvalanching) {
  expect_only("soil", {Layer::soil}, true, [](test::BenchTerrain& t) { t.avalanche_soil(); });
}
TEST_P(Contract, OfBedrockAvalanching) {
  expect_only("bedrock to sand", {Layer::bedrock, Layer::sand}, true,
              [](test::BenchTerrain& t) { t.avalanche_bedrock(); });
  expect_only("bedrock to bedrock", {Layer::bedrock}, true, [](test::BenchTerrain& t) {
    AvalanchingParameters p;
    p.bedrock_to_sand = false;
    t.avalanche_bedrock(p);
  });
}

TEST_P(Contract, OfPlants) {
  const auto with_plants = [](const auto& step) {
    return [step](test::BenchTerrain& t) {
      SpeciesTraits s;
      s.spawn = 5000;
      s.moisture_lowest = 0;
      s.moisture_highest = 1;
      s.sand = 1;
      s.slope = 100;
      plants::Workspace work = plants::make_workspace(t.exec(), t.grid(), t.grid().cells(), {s}, {1});
      // Some plants come up first, on a terrain that is set back.
      std::vector<std::vector<std::uint32_t>> before;
      for (const LayerInfo& row : layer_table) before.push_back(t.terrain.words(row.layer));
      with_backend(t.exec(), [&](auto& e) {
        plants::live(e, t.terrain.view(), {}, {}, t.heights, 1, 1, 1, t.ledger(), work);
      });
      ASSERT_GT(work.count, 20);
      for (const LayerInfo& row : layer_table)
        if (t.terrain.has(row.layer))
          t.terrain.set_words(row.layer, before[static_cast<std::size_t>(row.layer)]);
      with_backend(t.exec(), [&](auto& e) { step(e, t, work); });
      t.exec().synchronise();
    };
  };
  expect_only("plant cover", {Layer::vegetation, Layer::humus, Layer::canopy_height}, true,
              with_plants([](auto& e, test::BenchTerrain& t, plants::Workspace& work) {
                plants::cover(e, t.terrain.view(), {}, 1, t.heights, true, work);
              }));
  expect_only("a look at plant cover", {Layer::canopy_height}, true,
              with_plants([](auto& e, test::BenchTerrain& t, plants::Workspace& work) {
                plants::cover(e, t.terrain.view(), {}, 1, t.heights, false, work);
              }));
  expect_only("a look at species", {Layer::plants}, true,
              with_plants([](auto& e, test::BenchTerrain& t, plants::Workspace& work) {
                const TerrainView view = t.terrain.view();
                plants::mark_species(e, view, 0, view.grid.height, work.neighbourhood(), work.plants(),
                                     work.species.data());
              }));
  expect_only("illumination", {Layer::illumination, Layer::illumination_canopy}, true,
              with_plants([](auto& e, test::BenchTerrain& t, plants::Workspace& work) {
                plants::illuminate(e, t.terrain.view(), {}, t.heights, work);
              }));
  expect_only("vegetation", {Layer::moisture, Layer::humus}, true,
              with_plants([](auto& e, test::BenchTerrain& t, plants::Workspace& work) {
                plants::live(e, t.terrain.view(), {}, {}, t.heights, 1, 1, 2, t.ledger(), work);
              }));
}

DESERT_ON_EACH_BACKEND(Contract);

}  // namespace
}  // namespace desert_sim
