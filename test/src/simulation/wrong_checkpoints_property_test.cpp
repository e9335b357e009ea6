// Checkpoints whose checksum is right and whose content is wrong are refused with the field, its value and
// its range.

#include <functional>
#include <limits>

#include "kernels/base/math.hpp"
#include "src/simulation/checkpoint.hpp"
#include "test/support/checkpoint_parts.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

using plants::Column;
using test::CheckpointParts;
using Change = std::function<void(CheckpointParts&)>;

/// Rain that a timeline makes heavier, rivers, plants, a wind rose.
const char* const refused_world =
    "grid: {width: 24, height: 20, boundary: open}\n"
    "terrain:\n"
    "  - noise: {layer: bedrock, low: 0, high: 4, scale: 12}\n"
    "  - noise: {layer: soil, low: 0.5, high: 3, scale: 8, seed: 2}\n"
    "  - noise: {layer: sand, low: 0, high: 2, scale: 8, seed: 3}\n"
    "  - noise: {layer: moisture, low: 0.05, high: 0.2, scale: 8, seed: 4}\n"
    "wind: {regime: rose, hold_time: 2, segments: [{direction_deg: 10, speed: 6}, {direction_deg: 100}]}\n"
    "rain: {rate: 1.0e-4}\n"
    "vegetation: {enabled: true}\n"
    "species: [{preset: bush, spawn: 200, moisture_lowest: 0, light_highest: 2, slope: 9}, {preset: tree}]\n"
    "run: {timeline: [{time: 2, ramp: 100, set: {rain.rate: 2.0e-4}}, {time: 900, set: {wind.speed: 3}}]}\n";

class WrongCheckpoint : public ::testing::Test {
 protected:
  WrongCheckpoint() : exec_(make_exec("cpu", 1)) {
    auto s = test::simulate(*exec_, refused_world);
    test::run(*s, 6);
    bytes_ = checkpoint_bytes(*s);
  }

  /// Expects that the changed file is refused for a reason that contains `naming`.
  void refused(const Change& change, const std::string& naming) {
    CheckpointParts parts(bytes_);
    change(parts);
    try {
      load_checkpoint(folder_.write("wrong.ck", parts.bytes()), *exec_);
      ADD_FAILURE() << "was loaded: " << naming;
    } catch (const ConfigError& e) {
      EXPECT_NE(std::string(e.what()).find(naming), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("wrong.ck"), std::string::npos) << e.what();
    }
  }
  /// The same for one value of the header.
  void refused(const char* key, const std::string& value, const std::string& naming) {
    refused([&](CheckpointParts& p) { p.set(key, value); }, naming);
  }
  void refused(Layer layer, std::uint32_t word, const std::string& naming) {
    refused([&](CheckpointParts& p) { p.set_word(p.place(layer, 29), word); }, naming);
  }
  void refused(Layer layer, float value, const std::string& naming) {
    refused(layer, bits_of(value), naming);
  }
  void refused(Column column, std::uint32_t word, const std::string& naming) {
    refused([&](CheckpointParts& p) { p.set_word(p.place(column, 1), word); }, naming);
  }
  void refused(Column column, float value, const std::string& naming) {
    refused(column, bits_of(value), naming);
  }

  static constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  static constexpr float infinity = std::numeric_limits<float>::infinity();
  const std::unique_ptr<Exec> exec_;
  const test::TemporaryFolder folder_;
  std::string bytes_;
};

TEST_F(WrongCheckpoint, TakenApartAndPutTogetherAgainLoads) {
  const CheckpointParts parts(bytes_);
  ASSERT_GT(parts.parsed_header()["plants"].as<int>(), 2);
  ASSERT_EQ(parts.parsed_header()["ramps"].size(), 1u);
  EXPECT_TRUE(parts.bytes() == bytes_);
  EXPECT_TRUE(checkpoint_bytes(*load_checkpoint(folder_.write("right.ck", bytes_), *exec_)) == bytes_);
  CheckpointParts emitted(bytes_);  // the header in another form
  emitted.set_header(parts.parsed_header());
  EXPECT_TRUE(checkpoint_bytes(*load_checkpoint(folder_.write("right.ck", emitted.bytes()), *exec_)) ==
              bytes_);
}

TEST_F(WrongCheckpoint, NumbersOutOfRange) {
  refused("steps", "18446744073709551615", "steps: 18446744073709551615 is not in [0, 9007199254740992]");
  refused("steps", "-1", "steps: -1 is not in [0, ");
  refused("steps", "many", "steps: many is not a number");
  refused("datum", ".nan", "datum: .nan is not in [");
  refused("datum", "1e9", "datum: 1e9 is not in [");
  for (const char* exponent : {"1000000", "-1000000", "-21", "-7"})
    refused("exponent", exponent, std::string("exponent: ") + exponent + " is not in [-20, -8]");
  refused("wind_reference", "2000000000", "wind_reference: 2000000000 is not in [");
  refused("timeline_time", "7", "timeline_time: 7 is not in [-1, 6");
  refused("timeline_time", "soon", "timeline_time: soon is not in [-1, 6");
  refused(
      [](CheckpointParts& p) {  // of former versions
        YAML::Node header = p.parsed_header();
        header.remove("timeline_time");
        header["next_timeline_entry"] = 3;
        p.set_header(header);
      },
      "next_timeline_entry: 3 is not in [0, 2]");
  refused("bedrock_loose", "perhaps", "bedrock_loose: perhaps is not true or false");
}

TEST_F(WrongCheckpoint, CountsOfPlantsThatAreNotThere) {
  refused("plants", "-1", "plants: -1 is not in [0, ");
  refused("plants", "150000000", "plants: 150000000 is not in [0, 480]");
  refused("plants", "1", "bytes behind its header, which lists");
  refused(
      [](CheckpointParts& p) {  // with the room for them
        YAML::Node header = p.parsed_header();
        for (const char* key : {"start", "scenario"}) {
          std::string text = header[key].Scalar();
          const std::string none = "max_plants: 0";
          text.replace(text.find(none), none.size(), "max_plants: 200000000");
          header[key] = text;
        }
        header["plants"] = 150000000;
        p.set_header(header);
      },
      "which lists 48000");
}

TEST_F(WrongCheckpoint, FieldsThatAreMissingOrUnknown) {
  for (const auto& field : CheckpointParts(bytes_).parsed_header()) {
    const auto key = field.first.as<std::string>();
    const Change remove = [&](CheckpointParts& p) {
      YAML::Node header = p.parsed_header();
      header.remove(key);
      p.set_header(header);
    };
    if (key != "ripple_wind") {
      refused(remove, key + ": is missing");
      continue;
    }
    CheckpointParts older(bytes_);  // older versions did not write it
    remove(older);
    EXPECT_NO_THROW(load_checkpoint(folder_.write("older.ck", older.bytes()), *exec_));
  }
  refused("colour", "red", "colour: unknown key");
}

TEST_F(WrongCheckpoint, LayersThatDoNotGoWithTheScenario) {
  const auto layers = [&](const char* list, const std::string& naming) {
    refused([&](CheckpointParts& p) { p.set("layers", YAML::Load(list)); }, naming);
  };
  layers("[]", "layers: bedrock is missing");
  layers("[bedrock, soil, soil, sand]", "layers.2: 'soil' is given twice");
  layers("[soil, bedrock]", "layers.1: 'bedrock' is given twice, or not in the order");
  layers("[bedrock, elevation]", "layers.1: 'elevation' is not a layer that checkpoints hold");
  layers("[bedrock, slope]", "layers.1: 'slope' is not a layer");
  layers("[bedrock, dust]", "layers.1: 'dust' is not a layer");
  layers("[bedrock, [sand]]", "layers.1: 'a list' is not a layer");
  layers("[bedrock, soil, sand, airborne_sand]", "layers: water is missing, which this scenario needs");
  layers("sand", "layers: sand is not a list");
}

TEST_F(WrongCheckpoint, ValuesOfLayersOutOfTheirBounds) {
  refused(Layer::sand, 0xffffffffu, "layer sand at cell (5, 1): -1 is not in [0, 2147483647] quanta");
  refused(Layer::sand, 0x7fffffffu, "bedrock, soil, sand and water together at cell (5, 1): ");
  refused(Layer::airborne_sand, 1u << 30, "layer airborne_sand at cell (5, 1): 1073741824 is not in");
  refused(Layer::bedrock, 0x80000000u, "layer bedrock at cell (5, 1): -2147483648 is not in");
  refused(Layer::humus, 0x80000000u, "layer humus");
  refused(Layer::airborne_sand, 0x80000000u, "layer airborne_sand");
  refused(Layer::vegetation, 1.5f, "layer vegetation at cell (5, 1): 1.5 is not in [0, 1] 1");
  refused(Layer::vegetation, nan, "layer vegetation at cell (5, 1): nan");
  refused(Layer::water_flux_x, 1e38f, "layer water_flux_x at cell (5, 1): ");
  refused(Layer::water_flux_y, -infinity, "layer water_flux_y at cell (5, 1): -inf");
  refused(
      [](CheckpointParts& p) {
        for (Layer layer : {Layer::bedrock, Layer::sand}) p.set_word(p.place(layer, 29), (1u << 30) - 1);
      },
      "bedrock, soil, sand and water together at cell (5, 1): 21");
}

TEST_F(WrongCheckpoint, ValuesOfPlantsOutOfTheirBounds) {
  refused(Column::species, 2u, "plant 1: species: 2 is not in [0, 1]");
  refused(Column::species, 0xffffffffu, "plant 1: species: -1 is not in");
  for (const float radius : {1e30f, 20.1f, -1.0f, nan, infinity})
    refused(Column::radius, radius, "plant 1: radius: ");
  refused(Column::x, 24.1f, "plant 1: x: 24.10000038 is not in [0, 24] m");
  refused(Column::y, -0.1f, "plant 1: y: -0.1000000015 is not in [0, 20] m");
  refused(Column::z, 0x80000000u, "plant 1: z: ");
  refused(Column::health, 0.0f, "plant 1: health: 0");
  refused(Column::health, 1.1f, "plant 1: health: 1.1");
  refused(Column::water, nan, "plant 1: water: nan");
  refused(Column::age, -1.0f, "plant 1: age: -1");
}

TEST_F(WrongCheckpoint, AccountsThatDoNotClose) {
  const auto accounts = [&](const char* key, std::size_t n, const std::string& value,
                            const std::string& naming) {
    refused(
        [&](CheckpointParts& p) {
          YAML::Node header = p.parsed_header();
          header[key][n] = value;
          p.set_header(header);
        },
        naming);
  };
  accounts("ledger", 4, "17", "its accounts of sand are not those of its layers");
  accounts("initial", 1, "1000", "its accounts of soil are not those of its layers");
  accounts("initial", 1, "9223372036854775807", "initial.1: 9223372036854775807 is not in [");
  accounts("initial", 1, "much", "initial.1: much is not a whole number");
  accounts("ledger", 11, "-9223372036854775808", "ledger.11: -9223372036854775808 is not in [");
  refused("ledger", "0", "ledger: must be a list of 12 whole numbers");
  refused(Layer::sand, 77u, "its accounts of sand are not those of its layers");
}

TEST_F(WrongCheckpoint, RampsThatCannotBeGoingOn) {
  const auto ramp = [&](const char* key, const std::string& value, const std::string& naming) {
    refused(
        [&](CheckpointParts& p) {
          YAML::Node header = p.parsed_header();
          header["ramps"][0][key] = value;
          p.set_header(header);
        },
        naming);
  };
  ramp("path", "grid.width", "ramps.0.path: 'grid.width' is not a floating-point parameter that can change");
  ramp("path", "no.such", "ramps.0.path: 'no.such' is not");
  ramp("from", ".nan", "ramps.0.from: .nan is not in");
  ramp("to", "5", "ramps.0: rain.rate = 5.000000 is not in [0, 1] m/s");
  ramp("start", "1e6", "ramps.0.start: 1000000.000000 s is later than the present time");
  ramp("duration", "-1", "ramps.0.duration: -1 is not in [0, 1e+12] s");
  ramp("stair", "50", "ramps.0.stair: 50 is not in [0, 49]");
}

TEST_F(WrongCheckpoint, WindThatCannotBlow) {
  const auto wind = [&](const char* key, const YAML::Node& value, const std::string& naming) {
    refused(
        [&](CheckpointParts& p) {
          YAML::Node header = p.parsed_header();
          header["wind"][key] = value;
          p.set_header(header);
        },
        naming);
  };
  wind("start_time", YAML::Load(".nan"), "wind: start_time: nan is not in [-1e+30, 6.0");
  wind("start_time", YAML::Load("7"), "wind: start_time: 7.000000 is not in [-1e+30, 6.0");
  wind("from", YAML::Load("[.inf, 0]"), "wind: from: inf is not in");
  wind("segments", YAML::Load("[]"), "wind: segments: a rose needs at least one segment");
  wind("segments", YAML::Load("[{probability: 0}]"), "wind: segments: the probabilities of a rose");
  wind("hold_time", YAML::Load("0"), "wind: hold_time: 0 is not in");
}

TEST_F(WrongCheckpoint, ScenariosThatNoSimulationHas) {
  refused("scenario", "{}", "scenario: grid: width, height and cell_size must be given");
  refused("start", "grid: {width: 9, height: 9, cell_size: 1}", "start: its grid is not that of scenario");
  refused("scenario", "grid: {width: -1}", "scenario: grid.width: -1 is not in");
  refused("scenario", "[1", "its header cannot be read");
  refused([](CheckpointParts& p) { p.set("scenario", YAML::Load("[1]")); }, "scenario: a list is not text");
  refused(
      [](CheckpointParts& p) {
        YAML::Node header = p.parsed_header();
        for (const char* key : {"start", "scenario"}) {
          std::string text = header[key].Scalar();
          text.replace(text.find("width: 24"), 9, "width: 65536");
          text.replace(text.find("height: 20"), 10, "height: 30000");
          header[key] = text;
        }
        p.set_header(header);
      },
      "bytes behind its header, which lists");
  refused(
      [](CheckpointParts& p) {
        YAML::Node header = p.parsed_header();
        std::string text = header["scenario"].Scalar();
        text.replace(text.find("distance: 10"), 12, "distance: 999999");
        header["scenario"] = text;
        p.set_header(header);
      },
      "wind_shadow.distance");
}

TEST_F(WrongCheckpoint, BytesThatItsHeaderDoesNotList) {
  refused([](CheckpointParts& p) { p.words += "more"; }, "bytes behind its header, which lists");
  refused([](CheckpointParts& p) { p.words.clear(); }, "has 0 bytes behind its header, which lists");
}

}  // namespace
}  // namespace desert_sim
