// Checkpoints with mutated fields and words and a checksum that is right: refused with a ConfigError, or a
// simulation that saves the same file again, runs with books that close, and can be saved and loaded once
// more.
// DESERT_FUZZ_ROUNDS says how many.

#include <random>

#include "kernels/base/math.hpp"
#include "src/simulation/checkpoint.hpp"
#include "test/support/checkpoint_parts.hpp"
#include "test/support/fuzz_rounds.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

const char* const fuzzed_world =
    "grid: {width: 20, height: 16, boundary: open}\n"
    "terrain:\n"
    "  - noise: {layer: bedrock, low: 0, high: 4, scale: 12}\n"
    "  - noise: {layer: soil, low: 0.5, high: 3, scale: 8, seed: 2}\n"
    "  - noise: {layer: sand, low: 0, high: 2, scale: 8, seed: 3}\n"
    "  - noise: {layer: moisture, low: 0.05, high: 0.2, scale: 8, seed: 4}\n"
    "wind: {regime: rose, hold_time: 2, segments: [{direction_deg: 10, speed: 6}, {direction_deg: 100}],\n"
    "       features: [{kind: vortex, x: 10, y: 8, radius: 4, id: 1}]}\n"
    "rain: {rate: 1.0e-4}\n"
    "hydraulic_erosion: {enabled: true}\n"
    "vegetation: {enabled: true}\n"
    "species: [{preset: bush, spawn: 200, moisture_lowest: 0, light_highest: 2, slope: 9}, {preset: tree}]\n"
    "run: {check_every: 1, timeline: [{time: 2, ramp: 100, set: {rain.rate: 2.0e-4}}]}\n";

const char* const values[] = {"-1",   "0",     "1",          "0.5",        "1e9",     "-1e9",
                              ".nan", ".inf",  "-.inf",      "4294967296", "1000000", "9223372036854775807",
                              "[]",   "{}",    "~",          "true",       "sand",    "18446744073709551615",
                              "2",    "1e-45", "2147483647", "20",         "-20",     "-2147483648"};

class Mutation {
 public:
  explicit Mutation(unsigned seed) : random_(seed) {}

  void apply(test::CheckpointParts& parts) {
    switch (below(6)) {
      case 0:
        return flip_bit(parts);
      case 1:
        return set_plant(parts);
      case 2:
        return set_any_word(parts);
      case 3: {  // a bit of the header's text
        char& byte = parts.header[below(parts.header.size())];
        byte = static_cast<char>(byte ^ (1 << below(8)));
        return;
      }
      default: {
        YAML::Node header = parts.parsed_header();
        change_a_leaf(header);
        parts.set_header(header);
        return;
      }
    }
  }

 private:
  std::size_t below(std::size_t n) { return n > 0 ? random_() % n : 0; }

  void flip_bit(test::CheckpointParts& parts) {
    const std::size_t at = below(parts.word_count());
    parts.set_word(at, parts.word(at) ^ (1u << below(32)));
  }
  std::uint32_t any_word() {
    const std::uint32_t words[] = {0,
                                   1,
                                   0xffffffffu,
                                   0x7fffffffu,
                                   0x80000000u,
                                   (1u << 30) - 1,
                                   bits_of(1e30f),
                                   bits_of(0.5f),
                                   bits_of(19.9f),
                                   0x7fc00000u,
                                   0x00000001u,
                                   static_cast<std::uint32_t>(random_())};
    return words[below(std::size(words))];
  }
  void set_plant(test::CheckpointParts& parts) {
    const auto column = static_cast<plants::Column>(below(plants::column_count));
    const auto count = parts.parsed_header()["plants"].as<std::size_t>();
    parts.set_word(parts.place(column, below(count)), any_word());
  }
  void set_any_word(test::CheckpointParts& parts) { parts.set_word(below(parts.word_count()), any_word()); }

  /// Goes down at random, into the scenarios too, which are YAML in a text.
  void change_a_leaf(YAML::Node node) {
    if ((node.IsMap() || node.IsSequence()) && node.size() > 0) {
      std::size_t chosen = below(node.size());
      if (node.IsSequence()) {
        if (below(6) == 0) return node.push_back(YAML::Clone(node[chosen]));
        return change_child(node, chosen);
      }
      auto entry = node.begin();
      for (; chosen > 0; --chosen) ++entry;
      const auto key = entry->first.as<std::string>();
      if (below(40) == 0) {
        node.remove(key);
        return;
      }
      return change_child(node, key);
    }
    node = YAML::Load(values[below(std::size(values))]);
  }
  template <class Key>
  void change_child(YAML::Node node, const Key& key) {
    YAML::Node child = node[key];
    if (child.IsScalar() && child.Scalar().find('\n') != std::string::npos) {
      YAML::Node scenario = YAML::Load(child.Scalar());
      change_a_leaf(scenario);
      YAML::Emitter out;
      out << scenario;
      node[key] = std::string(out.c_str());
    } else if (child.IsScalar() || child.IsNull() || child.size() == 0) {
      node[key] = YAML::Load(values[below(std::size(values))]);
    } else {
      change_a_leaf(child);
    }
  }

  std::mt19937 random_;
};

TEST(CheckpointFuzz, MutatedCheckpointsAreRefusedOrRunAndAreSavedAgain) {
  const auto exec = make_exec("cpu", 1);
  const test::TemporaryFolder folder;
  auto s = test::simulate(*exec, fuzzed_world);
  test::run(*s, 6);
  ASSERT_GT(s->state().plants.count, 2);
  const std::string bytes = checkpoint_bytes(*s);
  const int rounds = test::fuzz_rounds(200);
  int refused = 0, ran = 0;
  for (int round = 0; round < rounds; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    test::CheckpointParts parts(bytes);
    Mutation(static_cast<unsigned>(round)).apply(parts);
    const std::string path = folder.write("fuzz.ck", parts.bytes());
    std::unique_ptr<Simulation> loaded;
    try {
      loaded = load_checkpoint(path, *exec);
    } catch (const ConfigError&) {
      ++refused;
      continue;
    }
    const std::string again = checkpoint_bytes(*loaded);
    ASSERT_TRUE(checkpoint_bytes(*load_checkpoint(folder.write("again.ck", again), *exec)) == again);
    const RunParameters& run = loaded->scenario().run;
    if (run.time_step > 10) continue;  // steps of minutes are not what is looked for here
    try {
      test::run(*loaded, 2);
    } catch (const StateError& e) {
      if (loaded->steps() < max_simulation_steps) FAIL() << e.what();
    }
    test::expect_sound(*loaded, "two steps later");
    ASSERT_FALSE(HasFailure());
    ASSERT_NO_THROW(load_checkpoint(folder.write("later.ck", checkpoint_bytes(*loaded)), *exec));
    ++ran;
  }
  EXPECT_GT(refused, rounds / 4);
  EXPECT_GT(ran, rounds / 20);
}

}  // namespace
}  // namespace desert_sim
