/// ~save_terrain, ~load_terrain and ~load_scenario, on a paused node with the scenario corner.yaml.
#include <desert_sim/ElevationGrid.h>
#include <desert_sim/LoadScenario.h>
#include <desert_sim/LoadTerrain.h>
#include <desert_sim/NewScenario.h>
#include <desert_sim/SaveScenario.h>
#include <desert_sim/SaveTerrain.h>
#include <desert_sim/SimulationStatus.h>
#include <std_srvs/Trigger.h>
#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "test/support/ros/service_tests.hpp"

namespace {

namespace fs = std::filesystem;
using namespace desert_sim;
using namespace node_test;

SaveTerrain::Request saving(const std::string& name, const std::string& format) {
  SaveTerrain::Request request;
  request.name = name;
  request.format = format;
  return request;
}
LoadTerrain::Request loading(const std::string& name) {
  LoadTerrain::Request request;
  request.name = name;
  return request;
}
LoadScenario::Request beginning(const std::string& name) {
  LoadScenario::Request request;
  request.name = name;
  return request;
}

/// The tests of this file take their node to another terrain; each brings it back to corner.yaml's.
class TerrainFiles : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(ros::param::get("/desert_sim/data_dir", folder_));
    if (!fs::exists(folder_ + "/start")) {
      const auto saved = call<SaveTerrain>("save_terrain", saving("start", "geotiff"));
      ASSERT_TRUE(saved.success) << saved.message;
    }
    const auto loaded = call<LoadScenario>("load_scenario", beginning("start/terrain.yaml"));
    ASSERT_TRUE(loaded.success) << loaded.message;
  }
  void write(const std::string& name, const std::string& text) {
    fs::create_directories(fs::path(folder_ + "/" + name).parent_path());
    std::ofstream(folder_ + "/" + name) << text;
  }
  std::string folder_;
};

TEST_F(TerrainFiles, GoOutAndComeBackInBothFormats) {
  Listener<ElevationGrid> keyframes("elevation");
  step(3);
  ASSERT_TRUE(wait_until([&] { return keyframes.last().step == 3; }));
  const ElevationGrid before = keyframes.last();
  for (const char* format : {"geotiff", "png16"}) {
    const auto saved = call<SaveTerrain>("save_terrain", saving(std::string("sites/") + format, format));
    ASSERT_TRUE(saved.success) << saved.message;
    EXPECT_TRUE(fs::exists(saved.path)) << saved.path;
  }
  for (const char* format : {"geotiff", "png16"}) {
    write("tiny.yaml", "grid: {width: 9, height: 7}\nterrain: [uniform: {layer: sand, value: 1}]\n");
    ASSERT_TRUE(call<LoadScenario>("load_scenario", beginning("tiny.yaml")).success);
    EXPECT_TRUE(wait_until([&] { return keyframes.last().width == 9 && keyframes.last().height == 7; }));
    const auto loaded = call<LoadTerrain>("load_terrain", loading(std::string("sites/") + format));
    ASSERT_TRUE(loaded.success) << loaded.message;
    EXPECT_EQ(loaded.state_hash, hash());
    EXPECT_TRUE(wait_until([&] { return keyframes.last().width == before.width; })) << "a new keyframe";
    const ElevationGrid after = keyframes.last();
    ASSERT_EQ(after.elevation.size(), before.elevation.size());
    EXPECT_EQ(after.step, 0u) << "the clock begins anew";
    EXPECT_EQ(after.origin.position.x, before.origin.position.x);
    double most = 0;
    for (std::size_t i = 0; i < after.elevation.size(); ++i)
      most = std::max(most, std::abs(static_cast<double>(after.elevation[i]) - before.elevation[i]));
    EXPECT_LT(most, 0.01) << format;
  }
}

TEST_F(TerrainFiles, AreRefusedWithTheReason) {
  expect_refused<SaveTerrain>("save_terrain", saving("a", "stl"), "format: 'stl'", "geotiff, png16, rosbag");
  expect_refused<SaveTerrain>("save_terrain", saving("a.bag", "rosbag"), "'a.bag'", ".bag");
  expect_refused<LoadTerrain>("load_terrain", loading("nowhere"), "nowhere", "");
  for (const std::string& name :
       {std::string(""), std::string("/tmp/a"), std::string("../a"), std::string("a/../../b")}) {
    expect_refused<SaveTerrain>("save_terrain", saving(name, "geotiff"), "'" + name + "/terrain.yaml'",
                                "~data_dir");
    expect_refused<LoadTerrain>("load_terrain", loading(name), "'" + name + "/terrain.yaml'", "~data_dir");
    expect_refused<LoadScenario>("load_scenario", beginning(name), "'" + name + "'", "~data_dir");
  }
  write("torn.yaml", "grid: {width: 9");
  expect_refused<LoadScenario>("load_scenario", beginning("torn.yaml"), "torn.yaml", "");
  write("wrong.yaml", "grid: {width: -9}\nsalt: 3\n");
  expect_refused<LoadScenario>("load_scenario", beginning("wrong.yaml"), "grid.width: -9", "salt");
}

TEST_F(TerrainFiles, ReadNoRasterOutsideTheDataFolder) {
  const fs::path outside = folder_ + "_outside.asc";
  std::ofstream(outside) << "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n";
  write("absolute.yaml", "terrain: [raster: {layer: bedrock, file: " + outside.string() + "}]\n");
  write("up.yaml", "grid: {from_raster: ../" + outside.filename().string() + "}\n");
  expect_refused<LoadScenario>("load_scenario", beginning("absolute.yaml"), outside.string(), "is not below");
  expect_refused<LoadScenario>("load_scenario", beginning("up.yaml"), outside.filename().string(),
                               "is not below");
  fs::remove(outside);
}

TEST_F(TerrainFiles, InstalledScenariosHaveNames) {
  Listener<SimulationStatus> statuses("status");
  const auto is_shown = [&](const std::string& scenario) {
    return wait_until([&] { return statuses.last().scenario == scenario; });
  };
  for (const char* name : {"dem", "nebkha"}) {  // the former has a raster beside it
    const auto loaded = call<LoadScenario>("load_scenario", beginning(name));
    ASSERT_TRUE(loaded.success) << loaded.message;
    EXPECT_TRUE(is_shown(name));
    EXPECT_EQ(loaded.state_hash, hash());
    step(1);
    EXPECT_TRUE(call<std_srvs::Trigger>("reset").success) << "its rasters are read again";
    EXPECT_EQ(loaded.state_hash, hash());
  }
  for (const char* name : {"venturi2", "../scenarios/dem", "dem.yaml", "./dem", "dem_example"})
    expect_refused<LoadScenario>("load_scenario", beginning(name), "'" + std::string(name) + "'", "");
  expect_refused<LoadScenario>("load_scenario", beginning("nebka"), "did you mean 'nebkha'?", "barchan, ");
  write("mine", "grid: {width: 9, height: 7}\n");
  EXPECT_TRUE(call<LoadScenario>("load_scenario", beginning("mine")).success) << "a file below ~data_dir";
}

TEST_F(TerrainFiles, AScenarioIsSavedWholeAndGoesOn) {
  step(4);
  SaveScenario::Request save;
  save.name = "kept/as it is";
  const auto saved = call<SaveScenario>("save_scenario", save);
  ASSERT_TRUE(saved.success) << saved.message;
  EXPECT_EQ(saved.path, folder_ + "/kept/as it is/scenario.yaml");
  EXPECT_EQ(saved.step, 4u);
  EXPECT_EQ(saved.state_hash, hash());
  step(3);
  const std::string later = hash();
  ASSERT_NE(later, saved.state_hash);
  for (const char* name : {"kept/as it is", "kept/as it is/scenario.yaml"}) {
    const auto loaded = call<LoadScenario>("load_scenario", beginning(name));
    ASSERT_TRUE(loaded.success) << loaded.message;
    EXPECT_EQ(loaded.state_hash, saved.state_hash);
    step(3);
    EXPECT_EQ(hash(), later) << "it goes on with the same bits";
  }
  EXPECT_TRUE(call<std_srvs::Trigger>("reset").success);
  EXPECT_EQ(hash(), saved.state_hash) << "a reset goes back to what was saved";
  for (const char* name : {"", "/tmp/a", "../a"}) {
    save.name = name;
    expect_refused<SaveScenario>("save_scenario", save, "/scenario.yaml'", "~data_dir");
  }
  write("beyond/scenario.yaml", "run: {start_from: /etc/passwd}\n");
  expect_refused<LoadScenario>("load_scenario", beginning("beyond"), "/etc/passwd", "");
  expect_refused<LoadScenario>("load_scenario", beginning("kept"), "'kept/scenario.yaml'", "no such file");
}

TEST_F(TerrainFiles, ANameMeansOneScenario) {
  Listener<SimulationStatus> statuses("status");
  const auto is_shown = [&](const std::string& scenario) {
    return wait_until([&] { return statuses.last().scenario == scenario; });
  };
  step(2);
  SaveScenario::Request save;
  for (const char* name : {"nebkha", "nebkha/", "./nebkha"}) {
    save.name = name;
    expect_refused<SaveScenario>("save_scenario", save,
                                 "name: '" + save.name + "' is that of an installed scenario", "'my_nebkha'");
  }
  EXPECT_FALSE(fs::exists(folder_ + "/nebkha"));
  save.name = "my_nebkha";
  const auto saved = call<SaveScenario>("save_scenario", save);
  ASSERT_TRUE(saved.success) << saved.message;
  EXPECT_EQ(call<LoadScenario>("load_scenario", beginning("my_nebkha")).state_hash, saved.state_hash);
  EXPECT_TRUE(is_shown("my_nebkha")) << "and not that of its file";

  fs::rename(folder_ + "/my_nebkha", folder_ + "/nebkha");
  const std::string installed = "package://desert_sim/config/scenarios/nebkha.yaml";
  expect_refused<LoadScenario>("load_scenario", beginning("nebkha"), "'nebkha/scenario.yaml'",
                               "'" + installed + "'");
  EXPECT_EQ(call<LoadScenario>("load_scenario", beginning("nebkha/scenario.yaml")).state_hash,
            saved.state_hash);
  EXPECT_NE(call<LoadScenario>("load_scenario", beginning(installed)).state_hash, saved.state_hash);
  EXPECT_TRUE(is_shown("nebkha"));
  fs::remove_all(folder_ + "/nebkha");
  write("nebkha", "grid: {width: 9, height: 7}\n");
  expect_refused<LoadScenario>("load_scenario", beginning("nebkha"), "'./nebkha'", "'" + installed + "'");
  EXPECT_TRUE(call<LoadScenario>("load_scenario", beginning("./nebkha")).success);
  fs::remove(folder_ + "/nebkha");
  EXPECT_TRUE(call<LoadScenario>("load_scenario", beginning("nebkha")).success);
}

TEST_F(TerrainFiles, WhatIsMissingHasNamesThatAreNear) {
  write("survey/terrain-bedrock-1.asc", "ncols 2\n");
  NewScenario::Request request;
  request.yaml = "grid: {from_raster: survey/bedrock.tif}\n";
  expect_refused<NewScenario>("new_scenario", request,
                              "'survey/bedrock.tif': no such file exists below " + folder_,
                              "did you mean 'terrain-bedrock-1.asc'?");
  expect_refused<LoadTerrain>("load_terrain", loading("strat"), "'strat/terrain.yaml'",
                              "did you mean 'start'?");
}

TEST_F(TerrainFiles, AScenarioTakesSettings) {
  Listener<ElevationGrid> keyframes("elevation");
  LoadScenario::Request request = beginning("nebkha");
  request.settings = {"grid.width=40", "grid.height=32", "grid.cell_size=0.5", "seed=7"};
  const auto loaded = call<LoadScenario>("load_scenario", request);
  ASSERT_TRUE(loaded.success) << loaded.message;
  EXPECT_TRUE(wait_until([&] { return keyframes.last().width == 40 && keyframes.last().height == 32; }));
  EXPECT_EQ(keyframes.last().cell_size, 0.5);
  request.settings = {"grid.width=0", "sand.model=dust", "grid"};
  expect_refused<LoadScenario>("load_scenario", request, "setting 'grid'", "path=value");
  request.settings.pop_back();
  expect_refused<LoadScenario>("load_scenario", request, "grid.width", "sand.model");
  EXPECT_EQ(hash(), loaded.state_hash) << "what is refused changes nothing";
}

TEST_F(TerrainFiles, AScenarioBeginsFromAText) {
  Listener<SimulationStatus> statuses("status");
  NewScenario::Request request;
  request.yaml = "grid: {width: 24, height: 18}\nterrain: [noise: {layer: sand, high: 2}]\n";
  request.settings = {"terrain.0.noise.high=3"};
  const auto begun = call<NewScenario>("new_scenario", request);
  ASSERT_TRUE(begun.success) << begun.message;
  EXPECT_EQ(begun.state_hash, hash());
  EXPECT_TRUE(wait_until([&] { return statuses.last().scenario == "new"; }));
  step(2);
  EXPECT_TRUE(call<std_srvs::Trigger>("reset").success);
  EXPECT_EQ(begun.state_hash, hash());
  request.name = "plain";
  request.settings.clear();
  EXPECT_NE(call<NewScenario>("new_scenario", request).state_hash, begun.state_hash);
  EXPECT_TRUE(wait_until([&] { return statuses.last().scenario == "plain"; }));
  request.name = "a/b";
  expect_refused<NewScenario>("new_scenario", request, "name: 'a/b'", "");
  request.name = "wrong";
  request.yaml = "grid: {width: -24}\nterain: []\n";
  expect_refused<NewScenario>("new_scenario", request, "grid.width: -24", "did you mean");
  request.yaml = "terrain: [raster: {layer: sand, file: /etc/passwd}]\n";
  expect_refused<NewScenario>("new_scenario", request, "/etc/passwd", "is not below");
  request.yaml.clear();
  expect_refused<NewScenario>("new_scenario", request, "yaml: is empty", "");
}

TEST_F(TerrainFiles, ReadNoFormatThatNamesOtherFiles) {
  write("passwd.vrt",
        "<VRTDataset rasterXSize=\"2\" rasterYSize=\"2\"><VRTRasterBand dataType=\"Byte\" band=\"1\" "
        "subClass=\"VRTRawRasterBand\"><SourceFilename relativetoVRT=\"0\">/etc/passwd</SourceFilename>"
        "<ImageOffset>0</ImageOffset><PixelOffset>1</PixelOffset><LineOffset>2</LineOffset></VRTRasterBand>"
        "</VRTDataset>");
  write("vrt.yaml", "grid: {from_raster: passwd.vrt}\nterrain: [raster: {layer: bedrock}]\n");
  write("vrt/terrain.yaml", "grid: {from_raster: ../passwd.vrt}\nterrain: [raster: {layer: bedrock}]\n");
  expect_refused<LoadScenario>("load_scenario", beginning("vrt.yaml"), "passwd.vrt", "GeoTIFF");
  expect_refused<LoadTerrain>("load_terrain", loading("vrt"), "passwd.vrt", "GeoTIFF");
}

TEST_F(TerrainFiles, AreRegularFilesWithPlainNames) {
  ASSERT_EQ(mkfifo((folder_ + "/fifo.yaml").c_str(), 0600), 0);
  ASSERT_EQ(mkfifo((folder_ + "/fifo.tif").c_str(), 0600), 0);
  write("beside_fifo.yaml", "grid: {from_raster: fifo.tif}\n");
  // An answer at all: who opens one of them waits for a writer, and there is none.
  expect_refused<LoadScenario>("load_scenario", beginning("fifo.yaml"), "'fifo.yaml'", "is not a file");
  expect_refused<LoadScenario>("load_scenario", beginning("beside_fifo.yaml"), "fifo.tif",
                               "is not a regular file");
  for (const std::string& name : {std::string("a\ngrid: {width: 3}"), std::string(300, 'a')}) {
    expect_refused<SaveTerrain>("save_terrain", saving(name, "geotiff"), "character", "~data_dir");
    expect_refused<LoadScenario>("load_scenario", beginning(name), "character", "~data_dir");
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int status = node_test::run_tests(argc, argv, "terrain_files");
  std::string folder;
  if (ros::param::get("/desert_sim/data_dir", folder)) fs::remove_all(folder);
  return status;
}
