// Mutated scenarios, journals and checkpoints: refused with a ConfigError or accepted, never anything else.

#include <yaml-cpp/yaml.h>

#include <random>

#include "src/simulation/checkpoint.hpp"
#include "src/simulation/journal.hpp"
#include "test/support/cases.hpp"
#include "test/support/edits.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

const char* const tokens[] = {"{",        "}",
                              "[",        "]",
                              ":",        ",",
                              "-",        "\n",
                              " ",        "\"",
                              "'",        "#",
                              "&a",       "*a",
                              "!",        "|",
                              ">",        "~",
                              "null",     ".nan",
                              ".inf",     "-1",
                              "0",        "1e308",
                              "1e-308",   "99999999999999999999",
                              "0x1f",     "017",
                              "true",     "{}",
                              "[]",       "\t",
                              "\0",       "\xff",
                              "\xc3\xa4", "%",
                              "@",        "`",
                              "? ",       "<<: *a",
                              "---\n",    "...\n",
                              "uniform",  "sand",
                              "terrain",  "wind: ",
                              "segments", "periodic",
                              "\r\n",     "0.1"};

std::string mutated(std::string text, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return n ? random() % n : 0; };
  for (std::size_t edits = 1 + (below(2) ? 0 : below(4)); edits > 0 && !text.empty(); --edits) {
    const std::size_t at = below(text.size());
    switch (below(8)) {
      case 0:
        text.erase(at, 1 + below(12));
        break;
      case 1:
        text.insert(at, tokens[below(std::size(tokens))]);
        break;
      case 2:
        text[at] = static_cast<char>(random());
        break;
      case 3:
        text.insert(at, text.substr(below(text.size()), below(40)));
        break;
      case 4:
      case 5:
      case 6: {  // another digit somewhere
        const std::size_t digit = text.find_first_of("0123456789", at);
        if (digit != std::string::npos) text[digit] = static_cast<char>('0' + below(10));
        break;
      }
      default:
        text.replace(at, 1 + below(3), tokens[below(std::size(tokens))]);
        break;
    }
  }
  return text;
}

std::vector<std::string> seeds() {
  std::vector<std::string> texts;
  for (const test::Case& c : test::process_cases(true))
    texts.push_back(test::grid_yaml(8, 8, "open") + c.yaml);
  texts.push_back(dump_scenario(test::scenario_of(texts.back())));
  return texts;
}

TEST(Fuzz, MutatedScenarioFilesAreRefusedOrLoaded) {
  const test::TemporaryFolder folder;
  const std::vector<std::string> texts = seeds();
  std::mt19937 random(7);
  int loaded = 0, refused = 0;
  for (int n = 0; n < 2500; ++n) {
    const std::string text = mutated(texts[random() % texts.size()], random);
    const std::string path = folder.write("fuzz.yaml", text);
    try {
      Scenario s = load_scenario(path);
      resolve_grid(s, no_raster_loader);
      dump_scenario(s);
      ++loaded;
    } catch (const ConfigError& e) {
      ++refused;
      EXPECT_FALSE(std::string(e.what()).empty());
    } catch (const std::exception& e) {
      ADD_FAILURE() << "not a ConfigError: " << e.what() << "\nfor\n" << text;
    }
  }
  EXPECT_GT(loaded, 100);
  EXPECT_GT(refused, 1000);
}

TEST(Fuzz, MutatedScenariosThatLoadAlsoRun) {
  const std::vector<std::string> texts = seeds();
  std::mt19937 random(11);
  CpuExec exec(1);
  int ran = 0;
  for (int n = 0; n < 1500; ++n) {
    const std::string text = mutated(texts[random() % texts.size()], random);
    try {
      const Scenario s = test::scenario_of(text);
      // Sizes that take long, and shadows of millions of steps, are not what is looked for here.
      if (static_cast<long>(s.grid.width) * s.grid.height > 4096 || s.grid.cell_size < 0.1) continue;
      Simulation simulation(exec, s, no_raster_loader);
      test::run(simulation, 2);
      test::expect_sound(simulation, "mutated");
      ++ran;
      if (testing::Test::HasFailure()) {
        ADD_FAILURE() << text;
        return;
      }
    } catch (const ConfigError&) {
    } catch (const YAML::Exception&) {  // scenario_of() gives the text to YAML itself
    } catch (const std::exception& e) {
      ADD_FAILURE() << e.what() << "\nfor\n" << text;
    }
  }
  EXPECT_GT(ran, 100);
}

TEST(Fuzz, MutatedSettingsAreRefusedOrApplied) {
  const test::TemporaryFolder folder;
  const std::string path = folder.write("a.yaml", seeds()[4]);
  std::mt19937 random(13);
  const std::vector<std::string> settings{"grid.width=12", "terrain.0.noise.value=3", "wind.radii=[200, 50]",
                                          "seed=5", "wind.speed=3"};
  for (int n = 0; n < 2000; ++n) {
    const std::string setting = mutated(settings[random() % settings.size()], random);
    try {
      load_scenario(path, {setting});
    } catch (const ConfigError&) {
    } catch (const std::exception& e) {
      ADD_FAILURE() << "not a ConfigError: " << e.what() << "\nfor --set '" << setting << "'";
    }
  }
}

TEST(Fuzz, MutatedJournalsAreRefusedOrRead) {
  const test::TemporaryFolder folder;
  {
    JournalWriter writer(folder.path("j"), 5, "cpu");
    writer.write(1, command::SetWind{3, 4, 5});
    command::EditTerrain edit;
    writer.write(2, edit);
    for (const command::EditTerrain& shape : test::one_of_each_shape()) writer.write(2, shape);
    command::SetWindSchedule schedule;
    schedule.regime.regime = WindRegimeKind::rose;
    schedule.regime.segments.resize(3);
    writer.write(2, schedule);
    writer.write(4, command::Reset{});
    writer.write(5, command::LoadCheckpoint{"a.ck", 1});
    writer.end(6);
  }
  const std::string journal = test::file_bytes(folder.path("j"));
  std::mt19937 random(17);
  for (int n = 0; n < 800; ++n) {
    const std::string text = mutated(journal, random);
    try {
      read_journal(folder.write("fuzz", text));
    } catch (const ConfigError&) {
    } catch (const std::exception& e) {
      ADD_FAILURE() << "not a ConfigError: " << e.what() << "\nfor\n" << text;
    }
  }
}

}  // namespace
}  // namespace desert_sim
