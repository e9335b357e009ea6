// Keys of the sand's models before sand.model: refused with what to write, rewritten, read in what was saved.
#include "src/scenario/former_keys.hpp"

#include <yaml-cpp/yaml.h>

#include "src/scenario/live_parameters.hpp"
#include "test/support/refusal.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

std::string refused_with(const std::string& yaml, const Settings& settings = {}) {
  try {
    parse_scenario_text(yaml, "a.yaml", settings);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(FormerKeys, AreRefusedWithTheLineToWrite) {
  const std::string file =
      refused_with("saltation: {model: continuum}\nslab_model: {kind: none, repose_deg: 30}\n");
  EXPECT_NE(
      file.find("saltation.model: is now sand.model; write sand.model=continuum (in a file: sand: {model: "
                "continuum}; desert_run --migrate FILE rewrites one)"),
      std::string::npos)
      << file;
  EXPECT_NE(file.find("slab_model.kind: is now sand.model; write sand.model=hops"), std::string::npos)
      << file;
  EXPECT_EQ(file.find("unknown"), std::string::npos) << file;
  const std::string relief = refused_with("detail: {ripples: false}\n", {"detail.ripples=false"});
  EXPECT_NE(relief.find("detail: is now the section micro_relief"), std::string::npos) << relief;
  EXPECT_EQ(relief.find("unknown"), std::string::npos) << relief;
  EXPECT_NE(refused_with("run: {timeline: [{time: 5, set: {detail.ripples: false}}]}\n")
                .find("detail.ripples: is now micro_relief.ripples; write micro_relief.ripples=false"),
            std::string::npos);
  EXPECT_NE(refused_with("{}", {"particle.kind=wang"}).find("write sand.model=wang"), std::string::npos);
  EXPECT_NE(refused_with("run: {timeline: [{time: 5, set: {slab_model.kind: werner}}]}\n")
                .find("write sand.model=werner"),
            std::string::npos);
  try {
    with_live_settings(parse_scenario_text("{}", "a"), {"slab_model.kind=werner"});
    ADD_FAILURE() << "was accepted";
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("is now sand.model"), std::string::npos) << e.what();
  }
}

struct Rewriting {
  const char *before, *now;
};

TEST(FormerKeys, AreRewrittenAndAllElseStays) {
  const Rewriting rewritings[] = {
      {"# Dunes.\nwind: {speed: 5}  # steady\nsaltation: {model: continuum}  # real units\n",
       "# Dunes.\nwind: {speed: 5}  # steady\nsand: {model: continuum}  # real units\n"},
      {"saltation: {model: desertscape_2019, lift: 0.1}\n",
       "sand: {model: desertscape_2019}\nsaltation: {lift: 0.1}\n"},
      {"saltation: {lift: 0.1, model: continuum}\n", "sand: {model: continuum}\nsaltation: {lift: 0.1}\n"},
      {"slab_model:\n  kind: werner  # 1995\n  slab_height: 0.1\nseed: 3\n",
       "sand: {model: werner}\nslab_model:\n  # 1995\n  slab_height: 0.1\nseed: 3\n"},
      {"particle:\n  # grains\n  kind: wang\n", "sand:\n  # grains\n  model: wang\n"},
      {"slab_model: {kind: none}  # no slabs\n# wind\nwind: {speed: 5}\n",
       "# no slabs\n# wind\nwind: {speed: 5}\n"},
      {"saltation: {model: hops, lift: 1}\nslab_model: {kind: bishop}\n",
       "saltation: {lift: 1}\nsand: {model: bishop}\n"},
      {"run:\n  timeline:\n    - {time: 5, set: {slab_model.kind: snow}}\n    - {time: 9, set: "
       "{slab_model.kind: none}}\n",
       "run:\n  timeline:\n    - {time: 5, set: {sand.model: snow}}\n    - {time: 9, set: {sand.model: "
       "hops}}\n"},
      {"\xEF\xBB\xBFname: é\nslab_model: {kind: momiji, repose_deg: 33.7}\n",
       "\xEF\xBB\xBFname: é\nsand: {model: momiji}\nslab_model: {repose_deg: 33.7}\n"},
      {"saltation: {lift: 1}  # hops\r\nslab_model: {kind: werner}\r\n",
       "saltation: {lift: 1}  # hops\r\nsand: {model: werner}\r\n"},
      {"detail: {ripples: true}  # a\nrun: {timeline: [{time: 5, set: {detail.bumps: false}}]}\n",
       "micro_relief: {ripples: true}  # a\nrun: {timeline: [{time: 5, set: {micro_relief.bumps: "
       "false}}]}\n"},
      {"# nothing to do\nsaltation: {lift: 1}\n", "# nothing to do\nsaltation: {lift: 1}\n"},
  };
  for (const Rewriting& r : rewritings) {
    EXPECT_EQ(migrated(r.before, "a.yaml"), r.now);
    EXPECT_EQ(migrated(r.now, "a.yaml"), r.now);
  }
}

TEST(FormerKeys, ASectionByBothItsNamesIsRefused) {
  const std::string both = "detail: {ripples: true}\nmicro_relief: {bumps: true}\n";
  const std::string why = test::refusal([&] { migrated(both, "a.yaml"); });
  EXPECT_NE(why.find("a.yaml: detail: is given beside micro_relief"), std::string::npos) << why;
}

TEST(FormerKeys, OfTwoModelsAreRefused) {
  EXPECT_THROW(migrated("slab_model: {kind: werner}\nparticle: {kind: wang}\n", "a.yaml"), ConfigError);
  EXPECT_THROW(migrated("saltation: {model: [\n", "a.yaml"), ConfigError);
}

TEST(FormerKeys, OfRecordedSettingsMeanWhatTheyMeant) {
  const auto now = [](const Settings& settings, SandModel present) {
    return without_former_keys(settings, present, "a journal").back();
  };
  EXPECT_EQ(now({"wind.speed=3", "slab_model.kind=werner"}, SandModel::hops), "sand.model=werner");
  EXPECT_EQ(now({"slab_model.kind=none"}, SandModel::werner), "sand.model=hops");
  EXPECT_EQ(now({"slab_model.kind=none"}, SandModel::continuum), "sand.model=continuum");
  EXPECT_EQ(now({"particle.kind=none"}, SandModel::werner), "sand.model=werner");
  EXPECT_EQ(now({"particle.kind=none", "slab_model.kind=momiji"}, SandModel::wang), "sand.model=momiji");
  EXPECT_EQ(now({"saltation.model=continuum"}, SandModel::hops), "sand.model=continuum");
  EXPECT_EQ(now({"saltation.model=continuum"}, SandModel::werner), "sand.model=werner");  // it had no effect
  EXPECT_EQ(now({"slab_model.kind=werner", "detail.bumps=true"}, SandModel::hops), "sand.model=werner");
  EXPECT_EQ(now({"detail.bumps=true"}, SandModel::hops), "micro_relief.bumps=true");
  EXPECT_EQ(without_former_keys({"wind.speed=3"}, SandModel::werner, "a"), Settings{"wind.speed=3"});
}

TEST(FormerKeys, OfASavedTerrainAreRead) {
  const test::TemporaryFolder folder;
  const std::string saved =
      "slab_model: {kind: bishop}\nparticle: {kind: none}\nsaltation: {model: hops}\ndetail: {bumps: "
      "false}\n";
  folder.write("saved.yaml", saved_terrain_comment + std::string("12 of dunes.\n") + saved);
  EXPECT_EQ(load_scenario(folder.path("saved.yaml")).get<SandParameters>().model, SandModel::bishop);
  folder.write("own.yaml", saved);
  EXPECT_THROW(load_scenario(folder.path("own.yaml")), ConfigError);
}

}  // namespace
}  // namespace desert_sim
