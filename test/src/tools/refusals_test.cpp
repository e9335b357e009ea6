// desert_run refuses wrong input: status 2, before it begins, one clear line that names the culprit, nothing
// left in --out.

#include <ogr_spatialref.h>
#include <sys/stat.h>

#include <csignal>
#include <cstdlib>
#include <cstring>

#include "src/io/raster.hpp"
#include "src/scenario/scenario.hpp"
#include "src/simulation/session.hpp"
#include "test/support/run_fixture.hpp"

namespace desert_sim {
namespace {

class Refusals : public test::DesertRun {
 protected:
  test::ProgramRun expect_refused(std::vector<std::string> arguments, const std::vector<std::string>& naming,
                                  bool one_line = true) {
    std::filesystem::remove_all(path("out"));
    arguments.insert(arguments.end(), {"--out", path("out")});
    const test::ProgramRun r = run(arguments);
    EXPECT_EQ(r.status, 2) << r.err;
    for (const std::string& text : naming)
      EXPECT_NE(r.err.find(text), std::string::npos) << "the message lacks '" << text << "':\n" << r.err;
    EXPECT_EQ(r.err.rfind("desert_run: ", 0), 0u) << r.err;
    if (one_line) {
      EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    }
    EXPECT_EQ(r.out, "");
    EXPECT_FALSE(std::filesystem::exists(path("out"))) << "left something in --out";
    return r;
  }
  /// Before the first step, not after hours of them: a run that begins says on which backend, and is
  /// interrupted.
  void expect_refused_at_once(std::vector<std::string> arguments, const std::vector<std::string>& naming) {
    arguments.insert(arguments.end(), {"--backend", "cpu", "--steps", "100000000"});
    const test::ProgramRun r = run(arguments, {{SIGINT, says_its_backend}});
    EXPECT_EQ(r.status, 2) << r.err;
    for (const std::string& text : naming) EXPECT_NE(r.err.find(text), std::string::npos) << r.err;
    EXPECT_FALSE(says_its_backend(r.err)) << "the run has begun:\n" << r.err;
  }
  static bool says_its_backend(const std::string& err) { return err.find("backend: ") != std::string::npos; }
  test::ProgramRun expect_text_refused(const std::string& yaml, const std::vector<std::string>& naming) {
    return expect_refused({folder_.write("wrong.yaml", yaml)}, naming);
  }
};

TEST_F(Refusals, UnknownKey) {
  expect_text_refused("grid: {widht: 40}\n", {"wrong.yaml", "grid.widht", "unknown", "width"});
}
TEST_F(Refusals, TextForANumber) {
  expect_text_refused("grid: {width: wide}\n", {"wrong.yaml", "grid.width", "wide", "65536"});
}
TEST_F(Refusals, NotANumber) {
  expect_text_refused("wind: {speed: .nan}\n", {"wrong.yaml", "wind.speed", ".nan", "100"});
}
TEST_F(Refusals, NegativeSize) {
  expect_text_refused("grid: {width: -40}\n", {"wrong.yaml", "grid.width", "-40"});
}
TEST_F(Refusals, ZeroSize) {
  const auto r = expect_refused({folder_.write("wrong.yaml", "grid: {width: 0, height: 0}\n")},
                                {"grid.width", "grid.height"}, false);
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 2) << "one line a fault";
}
TEST_F(Refusals, CellSizeZero) {
  expect_text_refused("grid: {cell_size: 0}\n", {"wrong.yaml", "grid.cell_size", "0"});
}
TEST_F(Refusals, RasterThatIsMissing) {
  expect_text_refused("grid: {width: 8, height: 8}\nterrain: [raster: {file: no_such.tif}]\n",
                      {"no_such.tif"});
  expect_text_refused("grid: {from_raster: no_such.tif}\n", {"no_such.tif"});
}
TEST_F(Refusals, RasterThatIsText) {
  folder_.write("text.tif", "this is no raster\n");
  expect_text_refused("grid: {width: 8, height: 8}\nterrain: [raster: {file: text.tif}]\n", {"text.tif"});
}
TEST_F(Refusals, ScenarioThatIsMissing) { expect_refused({path("no_such.yaml")}, {"no_such.yaml"}); }
TEST_F(Refusals, ScenarioThatIsAFolder) { expect_refused({path(".")}, {path(".")}); }
TEST_F(Refusals, ScenarioThatIsNoYaml) { expect_text_refused("grid: {width: [\n", {"wrong.yaml", "line"}); }
TEST_F(Refusals, GridWithMoreCellsThanIndices) {
  expect_text_refused("grid: {width: 65536, height: 32768}\n", {"65536 x 32768", "2147483648", "2143289344"});
}
TEST_F(Refusals, GridTooBigForMemory) {
  std::string layers;  // a few hundred GiB, whatever the machine
  for (const char* layer : {"soil", "water", "moisture", "humus", "vegetation", "suspended_sediment"})
    layers += std::string("  - uniform: {layer: ") + layer + ", value: 0}\n";
  expect_text_refused("grid: {width: 46000, height: 46000}\nterrain:\n" + layers,
                      {"46000 x 46000", "bytes", "GiB", " per cell", "available"});
}

TEST_F(Refusals, CheckpointThatIsCut) {
  run_cpu({scenario_, "--steps", "2", "--checkpoint", path("a.ck")});
  const std::string bytes = test::file_bytes(path("a.ck"));
  folder_.write("cut.ck", bytes.substr(0, bytes.size() / 2));
  expect_refused({scenario_, "--resume", path("cut.ck")}, {"cut.ck", "cut"});
  expect_refused({"--resume", path("cut.ck")}, {"cut.ck", "cut"});
}
TEST_F(Refusals, CheckpointOfAnotherVersion) {
  run_cpu({scenario_, "--steps", "2", "--checkpoint", path("a.ck")});
  std::string bytes = test::file_bytes(path("a.ck"));
  bytes[bytes.find('\n') + 1] = 99;
  folder_.write("new.ck", bytes);
  expect_refused({scenario_, "--resume", path("new.ck")}, {"new.ck", "version 99"});
}
TEST_F(Refusals, CheckpointThatIsMissing) {
  expect_refused({scenario_, "--resume", path("no.ck")}, {"no.ck"});
}
TEST_F(Refusals, CheckpointThatIsAFolder) { expect_refused({scenario_, "--resume", path(".")}, {path(".")}); }
TEST_F(Refusals, JournalThatIsMissingOrNone) {
  expect_refused({scenario_, "--replay", path("no.journal")}, {"no.journal"});
  expect_refused({scenario_, "--replay", folder_.write("empty.journal", "")}, {"empty.journal"});
  expect_refused({scenario_, "--replay", scenario_}, {"small.yaml"});
}

TEST_F(Refusals, UnknownOption) {
  expect_refused({scenario_, "--setps", "3"}, {"--setps", "unknown"});
  expect_refused({scenario_, "-x"}, {"-x"});
}
TEST_F(Refusals, OptionWithoutItsValue) {
  const test::ProgramRun r = run({scenario_, "--steps"});
  EXPECT_EQ(r.status, 2);
  EXPECT_NE(r.err.find("--steps"), std::string::npos) << r.err;
}
TEST_F(Refusals, OptionsThatAreNoNumbers) {
  for (const char* option : {"--steps", "--threads", "--every", "--checkpoint-every"})
    for (const char* value : {"many", "-1", "1.5", "", "99999999999999999999"}) {
      SCOPED_TRACE(std::string(option) + " '" + value + "'");
      expect_refused({scenario_, option, value}, {option});
    }
  expect_refused({scenario_, "--seed", "x"}, {"seed", "x"});
}
TEST_F(Refusals, WrongSettings) {
  expect_refused({scenario_, "--set", "grid.width"}, {"grid.width"});
  expect_refused({scenario_, "--set", "grid.width=-3"}, {"grid.width", "-3"});
  expect_refused({scenario_, "--set", "grid.wdith=3"}, {"grid.wdith"});
  expect_refused({scenario_, "--set", "terrain.9.uniform.value=3"}, {"terrain.9"});
}
TEST_F(Refusals, TwoScenariosOrNone) {
  expect_refused({scenario_, scenario_}, {"small.yaml"});
  expect_refused({}, {"scenario"});
}
TEST_F(Refusals, UnknownBackend) { expect_refused({scenario_, "--backend", "gpu"}, {"gpu", "cuda"}); }
TEST_F(Refusals, CudaWithoutADevice) {
  setenv("CUDA_VISIBLE_DEVICES", "", 1);  // hides what there may be
  expect_refused({scenario_, "--backend", "cuda"}, {"backend cuda: "});
  unsetenv("CUDA_VISIBLE_DEVICES");
}

TEST_F(Refusals, OutputsThatCannotBeWritten) {
  const test::ProgramRun below =
      run({scenario_, "--backend", "cpu", "--steps", "1", "--out", scenario_ + "/no/folder"});
  EXPECT_EQ(below.status, 2);
  EXPECT_NE(below.err.find("small.yaml/no/folder: cannot be created"), std::string::npos) << below.err;
  const test::ProgramRun file = run({scenario_, "--backend", "cpu", "--steps", "1", "--out", scenario_});
  EXPECT_EQ(file.status, 2);
  EXPECT_NE(file.err.find("small.yaml"), std::string::npos) << file.err;
}

TEST_F(Refusals, OutIsRemovedAgainIfAnotherOutputIsRefused) {
  const std::vector<std::string> more = {"--backend", "cpu", "--checkpoint", path("no/such/a.ck")};
  std::vector<std::string> arguments = {scenario_, "--out", path("deep/er/out")};
  arguments.insert(arguments.end(), more.begin(), more.end());
  EXPECT_EQ(run(arguments).status, 2);
  EXPECT_FALSE(std::filesystem::exists(path("deep")));
  std::filesystem::create_directories(path("deep/er"));
  EXPECT_EQ(run(arguments).status, 2);
  EXPECT_TRUE(std::filesystem::is_empty(path("deep/er")));
  EXPECT_TRUE(std::filesystem::exists(path("deep/er"))) << "it was there before";
}

TEST_F(Refusals, EmptyValues) {
  for (const char* option :
       {"--out", "--checkpoint", "--resume", "--replay", "--plot", "--set", "--backend"}) {
    const test::ProgramRun r = run({scenario_, "--backend", "cpu", "--steps", "1", option, ""});
    EXPECT_EQ(r.status, 2) << option;
    EXPECT_NE(r.err.find(std::string(option) + " ''"), std::string::npos) << r.err;
  }
}

TEST_F(Refusals, CheckpointThatCannotBeWrittenIsRefusedBeforeTheRun) {
  expect_refused_at_once({scenario_, "--checkpoint", path("no/such/a.ck")}, {"no/such/a.ck", "No such file"});
}
TEST_F(Refusals, CheckpointThatIsNoRegularFile) {
  folder_.write("precious", "bytes");
  std::filesystem::create_symlink(path("precious"), path("link"));
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  expect_refused_at_once({scenario_, "--checkpoint", path(".")}, {path("."), "names no file"});
  expect_refused_at_once({scenario_, "--checkpoint", path("link")}, {"link: ", "a symbolic link"});
  expect_refused_at_once({scenario_, "--checkpoint", path("pipe")}, {"pipe: ", "a pipe"});
  EXPECT_TRUE(std::filesystem::is_fifo(path("pipe")));
  EXPECT_EQ(test::file_bytes(path("precious")), "bytes");
}
TEST_F(Refusals, SummaryOrPlotThatIsNoRegularFile) {
  std::filesystem::create_directories(path("out/summary.json"));
  expect_refused_at_once({scenario_, "--out", path("out")}, {"--out", "summary.json", "a folder"});
  expect_refused_at_once({scenario_, "--out", path("fine"), "--every", "5", "--plot", path(".")},
                         {path("."), "names no file"});
}
TEST_F(Refusals, CheckpointThatWouldReplaceAnInput) {
  expect_refused_at_once({scenario_, "--checkpoint", scenario_},
                         {"--checkpoint", "small.yaml", "the scenario"});
  run_cpu({scenario_, "--steps", "3", "--checkpoint", path("a.ck")});
  {
    Session session(load_scenario(scenario_), no_raster_loader, "cpu", 1, path("j"));
    session.apply(command::LoadCheckpoint{path("a.ck"), 0});
    session.step();
  }
  const std::string bytes = test::file_bytes(path("a.ck"));
  const std::vector<std::string> replay = {scenario_, "--replay", path("j"), "--checkpoint"};
  for (const auto& [file, what] :
       {std::pair<std::string, std::string>{path("./a.ck"), "journal loads"}, {path("j"), "the journal"}}) {
    std::vector<std::string> arguments = replay;
    arguments.push_back(file);
    expect_refused_at_once(arguments, {"--checkpoint " + file, what});
  }
  EXPECT_EQ(test::file_bytes(path("a.ck")), bytes);
  run_cpu({scenario_, "--replay", path("j"), "--checkpoint", path("b.ck")});
  run_cpu({"--resume", path("b.ck"), "--steps", "6", "--checkpoint", path("b.ck")});
}

/// As in a conda environment: what the codes of projections mean would be unknown, and feet would be metres.
TEST_F(Refusals, AProjectionWithoutTheDatabaseOfPROJ) {
  Raster raster{4, 4, 10, 500000, 4400000, "", std::vector<float>(16, 1), {}, ""};
  OGRSpatialReference crs;
  ASSERT_EQ(crs.importFromEPSG(32613), OGRERR_NONE);
  char* wkt = nullptr;
  crs.exportToWkt(&wkt);
  raster.projection = wkt;
  CPLFree(wkt);
  write_geotiff(path("dem.tif"), raster);
  const std::string scenario = folder_.write(
      "dem.yaml", "grid: {from_raster: dem.tif, boundary: open}\nterrain: [raster: {layer: bedrock}]\n");
  run_cpu({scenario, "--steps", "1", "--checkpoint", path("a.ck")});
  std::filesystem::create_directory(path("proj"));
  for (const char* variable : {"PROJ_LIB", "PROJ_DATA"}) {
    setenv(variable, path("proj").c_str(), 1);
    expect_refused({scenario, "--steps", "1"}, {"dem.tif", "proj.db", path("proj")});
    expect_refused({"--resume", path("a.ck"), "--steps", "9"}, {"--out", "proj.db", path("proj")}, false);
    unsetenv(variable);
  }
}

TEST_F(Refusals, SettingsOfAResumedRunThatCannotChange) {
  run_cpu({scenario_, "--steps", "2", "--checkpoint", path("a.ck")});
  for (const char* setting : {"grid.width=8", "seed=7", "wind.sped=3", "wind.speed=fast"}) {
    const std::string name = std::string(setting).substr(0, std::string(setting).find('='));
    expect_refused({"--resume", path("a.ck"), "--set", setting}, {name});
    if (name != "wind.sped" && name != "wind.speed")
      expect_refused({scenario_, "--resume", path("a.ck"), "--set", setting}, {name});
  }
  expect_refused({"--resume", path("a.ck"), "--seed", "7"}, {"seed"});
}

}  // namespace
}  // namespace desert_sim
