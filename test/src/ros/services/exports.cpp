/// ~export_terrain, on a paused node with the scenario oasis.yaml, whose journal has the name of a picture
/// that an export could write.
#include <desert_sim/ExportTerrain.h>
#include <desert_sim/LoadScenario.h>
#include <desert_sim/NewScenario.h>
#include <desert_sim/SaveCheckpoint.h>
#include <std_srvs/Trigger.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <thread>

#include "src/export/export_formats.hpp"
#include "test/support/ros/child_process.hpp"
#include "test/support/ros/service_tests.hpp"
#include "test/support/temporary_folder.hpp"

namespace {

namespace fs = std::filesystem;
using namespace desert_sim;
using namespace node_test;
using test::file_bytes;

ExportTerrain::Request named(const std::string& name) {
  ExportTerrain::Request request;
  request.name = name;
  return request;
}

/// The endings that clients offer.
std::vector<std::string> offered_endings() {
  std::istringstream words(ExportTerrain::Request::ENDINGS);
  return {std::istream_iterator<std::string>(words), {}};
}

std::vector<std::string> endings() {
  std::vector<std::string> all;
  for (const ExportFormat& format : export_formats()) all.emplace_back(format.ending);
  return all;
}

/// Each begins with the start of oasis.yaml.
class Exports : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(ros::param::get("/desert_sim/data_dir", folder_));
    std::string oasis;
    ASSERT_TRUE(ros::param::get("/desert_sim/scenario", oasis));
    fs::create_directories(folder_);
    fs::copy_file(oasis, folder_ + "/oasis_here.yaml", fs::copy_options::overwrite_existing);
    ASSERT_TRUE(call<std_srvs::Trigger>("pause").success);
    begin("oasis_here.yaml");
  }
  void begin(const std::string& scenario) {
    LoadScenario::Request request;
    request.name = scenario;
    const auto loaded = call<LoadScenario>("load_scenario", request);
    ASSERT_TRUE(loaded.success) << loaded.message;
  }
  ExportTerrain::Response exported(const std::string& name) {
    const auto answer = call<ExportTerrain>("export_terrain", named(name));
    EXPECT_TRUE(answer.success) << answer.message;
    return answer;
  }
  /// desert_run writes its files, in each format, to the folder with that name.
  void run(std::vector<std::string> words, const std::string& folder) {
    fs::create_directories(folder_ + "/" + folder);
    words.insert(words.end(), {"--backend", "cpu", "--threads", "1", "--quiet"});
    for (const std::string& ending : endings())
      words.insert(words.end(), {"--export", folder_ + "/" + folder + "/scene" + ending});
    words.insert(words.begin(), DESERT_RUN_BINARY);
    EXPECT_EQ(ChildProcess(words).wait(), 0);
  }
  std::set<std::string> files_in(const std::string& folder) const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_ + "/" + folder))
      names.insert(entry.path().filename().string());
    return names;
  }
  void expect_same_files(const std::string& a, const std::string& b) {
    EXPECT_EQ(files_in(a), files_in(b));
    for (const std::string& name : files_in(a)) {
      const std::string bytes = file_bytes(folder_ + "/" + a + "/" + name);
      EXPECT_GT(bytes.size(), 50u) << name;
      EXPECT_TRUE(bytes == file_bytes(folder_ + "/" + b + "/" + name)) << a << "/" << name;
    }
  }
  /// Refused, and no file has come.
  void refused(const std::string& name, const std::string& what, const std::string& allowed) {
    const auto before = files_in("");
    expect_refused<ExportTerrain>("export_terrain", named(name), what, allowed);
    EXPECT_EQ(files_in(""), before) << name;
  }
  std::string folder_;
};

TEST_F(Exports, AreTheFilesOfDesertRunInEveryFormat) {
  step(40);
  std::set<std::string> told;
  for (const std::string& ending : endings()) {
    const auto answer = exported("of_node/scene" + ending);
    EXPECT_EQ(answer.path, folder_ + "/of_node/scene" + ending);
    EXPECT_EQ(answer.step, 40u);
    ASSERT_FALSE(answer.files.empty());
    EXPECT_EQ(answer.files[0], answer.path);
    for (const std::string& file : answer.files) told.insert(fs::path(file).filename().string());
  }
  EXPECT_EQ(told, files_in("of_node"));
  SaveCheckpoint::Request request;
  request.name = "at_40.ckpt";
  ASSERT_TRUE(call<SaveCheckpoint>("save_checkpoint", request).success);
  run({"--resume", folder_ + "/at_40.ckpt", "--steps", "0"}, "of_checkpoint");
  expect_same_files("of_node", "of_checkpoint");
  run({folder_ + "/oasis_here.yaml", "--steps", "40"}, "of_scenario");
  expect_same_files("of_node", "of_scenario");
#if DESERT_WITH_IO
  EXPECT_NE(file_bytes(folder_ + "/of_node/scene.obj").find("\no water\n"), std::string::npos);
  EXPECT_NE(file_bytes(folder_ + "/of_node/scene.obj").find("\no plants\n"), std::string::npos);
#endif
}

/// Of one step, whichever it is, while the simulation goes on.
TEST_F(Exports, AreOfOneMomentWhileItRuns) {
  ASSERT_TRUE(call<std_srvs::Trigger>("resume").success);
  ASSERT_TRUE(wait_until([] { return step(0).step > 3; }));
  const auto answer = exported("running/scene.ply");
  ASSERT_TRUE(wait_until([&] { return step(0).step > answer.step + 1; })) << "it goes on";
  run({folder_ + "/oasis_here.yaml", "--steps", std::to_string(answer.step)}, "running_again");
  EXPECT_TRUE(file_bytes(answer.path) == file_bytes(folder_ + "/running_again/scene.ply"));
}

TEST_F(Exports, ReplaceWhatWasThereAndChangeNoState) {
  const std::string before = hash();
  const std::string first = file_bytes(exported("same.stl").path);
  EXPECT_EQ(hash(), before);
  step(5);
  EXPECT_NE(file_bytes(exported("same.stl").path), first);
}

TEST_F(Exports, HaveTheEndingsThatClientsOffer) {
  const std::vector<std::string> offered = offered_endings();
  for (const std::string& ending : endings())
    EXPECT_EQ(std::count(offered.begin(), offered.end(), ending), 1) << ending;
  std::size_t without_library = 0;
  for (const std::string& ending : offered)
    if (const auto answer = call<ExportTerrain>("export_terrain", named("offered" + ending));
        !answer.success) {
      EXPECT_EQ(ending, ".glb") << answer.message;
      ++without_library;
    }
  EXPECT_EQ(offered.size(), endings().size() + without_library);
}

TEST_F(Exports, AreRefusedWithTheReason) {
  refused("a.dae", "a.dae: '.dae' is not an ending that this build exports", "(allowed: .ply, .stl");
  refused("a.word", "'.word' is not an ending", "did you mean '.world'?");
  refused("new/folder/a", "new/folder/a: has no ending", ".obj");
  refused(std::string(300, 'a') + ".ply", "characters", "~data_dir");
  refused("a\nb.ply", "control character", "~data_dir");
  for (const std::string& name : {std::string(""), folder_ + "/a.ply", std::string("../a.ply"),
                                  std::string("a/../../b.ply"), std::string(".."), std::string("a.ply/")})
    refused(name, "'" + name + "'", "~data_dir");
  fs::create_directories(folder_ + "/in_the_way_surface.png");
  refused("in_the_way.world", folder_ + "/in_the_way_surface.png: cannot be written: is a folder", "allowed");
  refused("kept.obj", folder_ + "/kept_ground.png: cannot be saved: the journal", "another name");
}

TEST_F(Exports, StayBelowTheDataFolder) {
  const std::string outside = folder_ + "_outside";
  fs::create_directories(outside);
  std::ofstream(outside + "/picture.png") << "of others";
  fs::remove(folder_ + "/leads_out");
  fs::create_symlink(outside, folder_ + "/leads_out");
  fs::remove(folder_ + "/linked_ground.png");
  fs::create_symlink(outside + "/picture.png", folder_ + "/linked_ground.png");
  refused("leads_out/a.ply", "'leads_out/a.ply'", "");
  refused("linked_ground.png", "'linked_ground.png'", "");
  refused("linked.obj", folder_ + "/linked_ground.png: cannot be written: is a symbolic link", "");
  EXPECT_EQ(file_bytes(outside + "/picture.png"), "of others");
  EXPECT_EQ(std::distance(fs::directory_iterator(outside), {}), 1);
  fs::remove_all(outside);
}

TEST_F(Exports, NeedASurfaceAndDoNotReplaceRastersOfTheScenario) {
  NewScenario::Request request;
  request.yaml = "grid: {width: 1, height: 9}\nterrain: [uniform: {layer: sand, value: 1}]\n";
  ASSERT_TRUE(call<NewScenario>("new_scenario", request).success);
  refused("thin.stl", folder_ + "/thin.stl: a terrain of 1 x 9 cells has no surface", "at least 2 x 2");
  exported("thin.exr");

  begin("oasis_here.yaml");
  exported("dem.exr");
  const std::string before = file_bytes(folder_ + "/dem.exr");
  request.yaml =
      "grid: {width: 40, height: 32}\nterrain: [raster: {layer: bedrock, file: dem.exr, stretch: true}]\n";
  const auto begun = call<NewScenario>("new_scenario", request);
  ASSERT_TRUE(begun.success) << begun.message;
  refused("dem.exr", "dem.exr, which the run reads", "another name");
  fs::remove(folder_ + "/alias");
  fs::create_symlink(folder_, folder_ + "/alias");
  refused("alias/dem.exr", "dem.exr, which the run reads", "another name");
  EXPECT_EQ(file_bytes(folder_ + "/dem.exr"), before);
}

/// It is given up, and leaves no part behind. On a machine that writes 340 MB of text before the node hears
/// that it is to end, the file is there whole; whether the answer comes through then is open.
TEST_F(Exports, DoNotKeepANodeThatIsToEnd) {
  std::ofstream(folder_ + "/large.yaml") << "grid: {width: 1400, height: 1400}\n"
                                            "terrain: [uniform: {layer: sand, value: 1}]\n";
  const std::string name = "/large_node", folder = folder_ + "/large";
  NodeProcess node(name, {{"scenario", folder_ + "/large.yaml"}, {"data_dir", folder}});
  ASSERT_TRUE(wait_until([&] { return ros::service::exists(name + "/export_terrain", false); }));
  ExportTerrain exchange;
  exchange.request = named("large.obj");
  std::thread client([&] { ros::service::call(name + "/export_terrain", exchange); });
  const auto part = [&] {
    if (!fs::exists(folder)) return false;
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().filename().string().rfind(".large.obj.", 0) == 0) return true;
    return false;
  };
  EXPECT_TRUE(wait_until(part));
  EXPECT_EQ(node.end(SIGTERM), 0);
  client.join();
  EXPECT_FALSE(part());
  const bool written = fs::exists(folder + "/large.obj");
  EXPECT_TRUE(written || !exchange.response.success);
  if (written) {
    EXPECT_GT(fs::file_size(folder + "/large.obj"), 300'000'000u);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int status = node_test::run_tests(argc, argv, "exports");
  std::string folder;
  if (ros::param::get("/desert_sim/data_dir", folder)) fs::remove_all(folder);
  return status;
}
