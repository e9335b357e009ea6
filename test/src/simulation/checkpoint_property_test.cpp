// Checkpoints: what is cut, flipped or of another version is refused with a reason and changes nothing.

#include <cstring>
#include <filesystem>

#include "kernels/sand/saltation.hpp"
#include "src/simulation/checkpoint.hpp"
#include "src/simulation/processes/sand_slopes.hpp"
#include "src/simulation/session.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

const char* const saved_world =
    "grid: {width: 21, height: 17, boundary: open, origin_x: 1000.5, origin_y: -20}\n"
    "terrain: [noise: {layer: bedrock, low: 100.25, high: 107, scale: 10}, noise: {layer: sand, low: 0, "
    "high: 3}]\n"
    "wind: {regime: rose, hold_time: 3, segments: [{direction_deg: 10, speed: 6}, {direction_deg: 100, "
    "speed: 4}]}\n"
    "run: {time_step: 0.7}\n";

class Checkpoint : public test::OnBackend {
 protected:
  std::string saved(const std::string& name = "a.ck", int steps = 5) {
    auto s = simulation(saved_world);
    test::run(*s, steps);
    save_checkpoint(folder_.path(name), *s);
    return folder_.path(name);
  }
  /// The reason why the file is refused; empty (and a failure) if it is not.
  std::string refusal(const std::string& path) {
    try {
      load_checkpoint(path, exec());
    } catch (const ConfigError& e) {
      return e.what();
    } catch (const std::exception& e) {
      ADD_FAILURE() << "not a ConfigError: " << e.what();
      return e.what();
    }
    ADD_FAILURE() << "was loaded";
    return "";
  }
  test::TemporaryFolder folder_;
};

TEST_P(Checkpoint, ContinuesToTheBitAfterSaltationWasSwitchedOff) {
  auto s = simulation(saved_world);
  test::run(*s, 5);
  s->apply(command::SetParameters{{"saltation.enabled=false"}});
  save_checkpoint(folder_.path("a.ck"), *s);
  const auto loaded = load_checkpoint(folder_.path("a.ck"), exec());
  test::run(*s, 5);
  test::run(*loaded, 5);
  EXPECT_EQ(s->state().hash(), loaded->state().hash()) << "impacts went on without grains";
}

/// In the middle of a second, the wind's shadow of its beginning is part of the state.
TEST_P(Checkpoint, ContinuesToTheBitInTheMiddleOfASecond) {
  for (const char* shadow : {"", "wind_shadow: {enabled: false}\n"}) {
    auto s = simulation(
        "grid: {width: 40, height: 24}\nterrain: [noise: {layer: sand, low: 0, high: 5, scale: 6}]\n"
        "wind: {speed: 4}\nsaltation: {lift: 0.5}\nrun: {time_step: 0.25}\n" +
        std::string(shadow));
    test::run(*s, 6);
    save_checkpoint(folder_.path("a.ck"), *s);
    const auto loaded = load_checkpoint(folder_.path("a.ck"), exec());
    EXPECT_EQ(s->state().hash(), loaded->state().hash()) << shadow;
    test::run(*s, 1);
    test::run(*loaded, 1);
    EXPECT_EQ(s->state().hash(), loaded->state().hash()) << shadow;
  }
}

/// Likewise in the middle of another time for which it is held, also if that has just been changed.
TEST_P(Checkpoint, ContinuesToTheBitWhileTheShadowIsHeld) {
  for (const bool changed : {false, true}) {
    auto s = simulation(
        "grid: {width: 40, height: 24}\nterrain: [noise: {layer: sand, low: 0, high: 5, scale: 6}]\n"
        "wind: {speed: 4}\nsaltation: {lift: 0.5}\nrun: {time_step: 1, hold_time: 4}\n");
    test::run(*s, 6);
    if (changed) s->apply(command::SetParameters{{"run.hold_time=5"}});
    save_checkpoint(folder_.path("a.ck"), *s);
    const auto loaded = load_checkpoint(folder_.path("a.ck"), exec());
    EXPECT_EQ(s->state().hash(), loaded->state().hash()) << changed;
    test::run(*s, 1);
    test::run(*loaded, 1);
    EXPECT_EQ(s->state().hash(), loaded->state().hash()) << changed;
  }
}

TEST_P(Checkpoint, CutAnywhereIsRefused) {
  const std::string bytes = test::file_bytes(saved());
  for (std::size_t n = 0; n < 16; ++n) {
    const std::string path = folder_.write("cut.ck", bytes.substr(0, bytes.size() * n / 16));
    EXPECT_NE(refusal(path).find("cut.ck"), std::string::npos) << "the reason names no file";
  }
  for (std::size_t last : {1u, 4u, 8u, 9u})
    refusal(folder_.write("cut.ck", bytes.substr(0, bytes.size() - last)));
}

TEST_P(Checkpoint, WithOneFlippedByteIsRefused) {
  const std::string bytes = test::file_bytes(saved());
  for (std::size_t n = 0; n < 64; ++n) {
    std::string broken = bytes;
    const std::size_t at = (bytes.size() - 1) * n / 63;
    broken[at] = static_cast<char>(broken[at] ^ 0x40);
    EXPECT_FALSE(refusal(folder_.write("flipped.ck", broken)).empty()) << "byte " << at;
  }
}

TEST_P(Checkpoint, WithSomethingBehindItIsRefused) {
  refusal(folder_.write("long.ck", test::file_bytes(saved()) + "x"));
}

TEST_P(Checkpoint, OfAnotherVersionIsRefusedByItsNumber) {
  std::string bytes = test::file_bytes(saved());
  const std::size_t at = bytes.find('\n') + 1;
  const std::uint32_t version = 7;
  std::memcpy(&bytes[at], &version, sizeof version);
  const std::string reason = refusal(folder_.write("new.ck", bytes));
  EXPECT_NE(reason.find("version 7"), std::string::npos) << reason;
}

TEST_P(Checkpoint, ThatIsNoneIsRefused) {
  refusal(folder_.path("missing.ck"));
  refusal(folder_.write("empty.ck", ""));
  refusal(folder_.write("text.ck", "grid: {width: 3}\n"));
  refusal(folder_.path("."));
}

TEST_P(Checkpoint, ThatCannotBeWrittenLeavesNothing) {
  auto s = simulation(saved_world);
  EXPECT_THROW(save_checkpoint(folder_.path("no/such/folder.ck"), *s), ConfigError);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path("")));
}

TEST_P(Checkpoint, LeavesNoTemporaryFile) {
  saved("a.ck");
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path(""))) {
    ++files;
    EXPECT_EQ(entry.path().filename(), "a.ck");
  }
  EXPECT_EQ(files, 1);
}

TEST_P(Checkpoint, RefusedLeavesTheSessionAsItWas) {
  const std::string bytes = test::file_bytes(saved());
  const std::string cut = folder_.write("cut.ck", bytes.substr(0, bytes.size() / 2));
  Session session(test::scenario_of(saved_world), no_raster_loader, GetParam(), 1);
  for (int n = 0; n < 3; ++n) session.step();
  const std::uint64_t before = session.simulation().state().hash();
  EXPECT_THROW(session.apply(command::LoadCheckpoint{cut, 0}), ConfigError);
  EXPECT_THROW(session.apply(command::LoadCheckpoint{saved(), 12345}), ConfigError);
  EXPECT_EQ(session.simulation().state().hash(), before);
  EXPECT_EQ(session.simulation().steps(), 3u);
}

/// Terrain, parameters and wind of the scenario that the checkpoint is of, not as commands had changed them.
TEST_P(Checkpoint, TakesAResetToTheStartOfItsOwnScenario) {
  Session session(test::scenario_of(saved_world), no_raster_loader, GetParam(), 1);
  const std::uint64_t start = session.simulation().state().hash();
  const std::string scenario = dump_scenario(session.simulation().scenario());
  session.apply(command::SetParameters{{"saltation.lift=0.3"}});
  session.apply(command::SetWind{33, 7, 0});
  for (int n = 0; n < 3; ++n) session.step();
  session.save_checkpoint(folder_.path("own.ck"));

  Session other(test::scenario_of("grid: {width: 8, height: 9}\n"), no_raster_loader, GetParam(), 1);
  other.apply(command::LoadCheckpoint{folder_.path("own.ck"), 0});
  EXPECT_EQ(other.simulation().scenario().get<SaltationParameters>().lift, 0.3f);
  other.apply(command::Reset{});
  EXPECT_EQ(other.simulation().state().hash(), start);
  EXPECT_EQ(dump_scenario(other.simulation().scenario()), scenario);
  other.step();
  session.apply(command::Reset{});
  session.step();
  EXPECT_EQ(other.simulation().state().hash(), session.simulation().state().hash());
}

/// Its scenario's raster may be a file that the session's loader does not read.
TEST_P(Checkpoint, OfAScenarioWhoseRasterMayNotBeReadIsNotResetTo) {
  const RasterLoader loader = [](const RasterRequest& request) {
    RasterField field;
    field.values.assign(static_cast<std::size_t>(request.width) * request.height, 5);
    return field;
  };
  const char* const on_raster =
      "grid: {width: 8, height: 9}\nterrain: [raster: {file: /elsewhere/dem.tif}]\n";
  Session(test::scenario_of(on_raster), loader, GetParam(), 1).save_checkpoint(folder_.path("raster.ck"));
  Session session(test::scenario_of("grid: {width: 8, height: 9}\n"), no_raster_loader, GetParam(), 1);
  session.apply(command::LoadCheckpoint{folder_.path("raster.ck"), 0});
  const std::uint64_t before = session.simulation().state().hash();
  try {
    session.apply(command::Reset{});
    ADD_FAILURE() << "was reset";
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("/elsewhere/dem.tif"), std::string::npos) << e.what();
  }
  EXPECT_EQ(session.simulation().state().hash(), before);
}

TEST_P(Checkpoint, IsReadBelowTheFolderOnlyIfCommandsAreConfined) {
  const std::string outside = saved(), data = folder_.path("data");
  std::filesystem::create_directory(data);
  std::filesystem::copy_file(outside, data + "/inside.ck");
  std::filesystem::create_symlink(outside, data + "/link.ck");
  folder_.write("outside.yaml", "grid: {width: 5}\n");
  Session session(test::scenario_of("grid: {width: 8, height: 9}\n"), no_raster_loader, GetParam(), 1);
  session.confine_commands(data);
  const std::uint64_t before = session.simulation().state().hash();
  EXPECT_THROW(session.apply(command::LoadCheckpoint{outside, 0}), ConfigError);
  EXPECT_THROW(session.apply(command::LoadCheckpoint{data + "/link.ck", 0}), ConfigError);
  EXPECT_THROW(session.apply(command::LoadScenario{folder_.path("outside.yaml"), false, 0}), ConfigError);
  EXPECT_EQ(session.simulation().state().hash(), before);
  session.apply(command::LoadCheckpoint{data + "/inside.ck", 0});
  EXPECT_NE(session.simulation().state().hash(), before);
}

TEST_P(Checkpoint, KeepsClockWindOriginAndBooks) {
  auto s = simulation(saved_world);
  command::SetWind wind;
  wind.speed = 7.3f;
  wind.direction_deg = 33.3f;
  wind.ramp = 20;
  test::run(*s, 4);
  s->apply(wind);
  test::run(*s, 4);
  save_checkpoint(folder_.path("b.ck"), *s);
  auto t = load_checkpoint(folder_.path("b.ck"), exec());
  EXPECT_EQ(t->time(), s->time());
  EXPECT_EQ(t->state().wind_above().x, s->state().wind_above().x);
  EXPECT_EQ(t->state().wind_above().y, s->state().wind_above().y);
  EXPECT_EQ(t->scenario().grid.origin_x, 1000.5);
  EXPECT_EQ(t->terrain().scale().datum, s->terrain().scale().datum);
  EXPECT_EQ(dump_scenario(t->scenario()), dump_scenario(s->scenario()));
  const auto a = s->state().balance(), b = t->state().balance();
  for (std::size_t m = 0; m < a.size(); ++m) {
    EXPECT_EQ(a[m].in, b[m].in);
    EXPECT_EQ(a[m].out, b[m].out);
    EXPECT_EQ(a[m].initial, b[m].initial);
    EXPECT_EQ(b[m].residual(), 0);
  }
  for (Layer layer : test::persistent_layers(*s))
    EXPECT_TRUE(s->terrain().raw_words(layer) == t->terrain().raw_words(layer));
}

TEST_P(Checkpoint, SavedTwiceIsTheSameFile) {
  EXPECT_TRUE(test::file_bytes(saved("a.ck")) == test::file_bytes(saved("b.ck")));
}

/// A picture or message made right after loading must show the wind, not calm air.
TEST_P(Checkpoint, SnapshotsAfterLoadingShowWindAndElevation) {
  auto s = simulation(
      "grid: {width: 24, height: 20}\nterrain: [uniform: {layer: sand, value: 2}]\nwind: {speed: 5}\n");
  test::run(*s, 3);
  save_checkpoint(folder_.path("c.ck"), *s);
  auto t = load_checkpoint(folder_.path("c.ck"), exec());
  const auto before = s->views().snapshot({Layer::elevation, Layer::wind_x}),
             after = t->views().snapshot({Layer::elevation, Layer::wind_x});
  EXPECT_TRUE(*before->find(Layer::elevation) == *after->find(Layer::elevation));
  EXPECT_NEAR((*before->find(Layer::wind_x))[7], 5, 0.1);
  EXPECT_NEAR((*after->find(Layer::wind_x))[7], 5, 0.1);
}

/// Only fluxes are part of the state; velocities follow from them and the depth, within 15 % here.
TEST_P(Checkpoint, SnapshotsAfterLoadingShowTheWatersVelocity) {
  for (const char* model : {"pipes", "shallow_water"}) {
    SCOPED_TRACE(model);
    auto s = simulation(
        "grid: {width: 24, height: 9, cell_size: 2, boundary: open}\n"
        "terrain: [ramp: {layer: bedrock, value: 1, slope_x: -0.01}]\n"
        "water: {model: " +
        std::string(model) +
        ", drag: 0.02, evaporation: 0, springs: [{x: 9, y: 9, radius: 6, discharge: 8}]}\n"
        "run: {time_step: 0.5}\n");
    test::run(*s, 100);
    save_checkpoint(folder_.path("a.ck"), *s);
    const auto loaded = load_checkpoint(folder_.path("a.ck"), exec());
    const std::vector<Layer> layers{Layer::water_velocity_x, Layer::water_velocity_y};
    const auto a = s->views().snapshot(layers), b = loaded->views().snapshot(layers);
    for (const Layer layer : {Layer::water_velocity_x, Layer::water_velocity_y}) {
      double off = 0, all = 0;
      for (int y = 1; y < 8; ++y)
        for (int x = 1; x < 23; ++x) {
          const auto i = static_cast<std::size_t>(24 * y + x);
          const double kept = a->layers.at(layer)[i], found = b->layers.at(layer)[i];
          off += (kept - found) * (kept - found);
          all += kept * kept;
        }
      EXPECT_GT(std::sqrt(all / 154), 0.1) << info(layer).name;
      EXPECT_LT(off, 0.25 * 0.25 * all) << info(layer).name;
    }
  }
}

/// The angles of repose follow from the layers (but for what the wind takes off them, which the next step
/// knows): a loaded world is not all avalanches.
TEST_P(Checkpoint, ReportsAResidualLikeTheOneBefore) {
  auto s = simulation(
      "grid: {width: 32, height: 32}\nreptation: {method: \"off\"}\n"
      "terrain: [noise: {layer: sand, low: 0, high: 8, scale: 8}]\n");
  test::run(*s, 3);
  save_checkpoint(folder_.path("d.ck"), *s);
  auto t = load_checkpoint(folder_.path("d.ck"), exec());
  EXPECT_NEAR(sand_residual(t->state(), t->pipeline()).share_over_1e3,
              sand_residual(s->state(), s->pipeline()).share_over_1e3, 1e-6);
  EXPECT_NEAR(sand_residual(t->state(), t->pipeline()).largest_excess,
              sand_residual(s->state(), s->pipeline()).largest_excess, 1e-6);
  EXPECT_GT(sand_residual(s->state(), s->pipeline()).largest_excess, 0.01);
}

DESERT_ON_EACH_BACKEND(Checkpoint);

}  // namespace
}  // namespace desert_sim
