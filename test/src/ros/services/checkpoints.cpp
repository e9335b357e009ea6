/// ~save_checkpoint and ~load_checkpoint, on a paused node with the scenario corner.yaml.
#include <desert_sim/ElevationGrid.h>
#include <desert_sim/LoadCheckpoint.h>
#include <desert_sim/SaveCheckpoint.h>

#include <filesystem>

#include "test/support/ros/service_tests.hpp"

namespace {

namespace fs = std::filesystem;
using namespace desert_sim;
using namespace node_test;

class Checkpoints : public Services {
 protected:
  void SetUp() override {
    Services::SetUp();
    ASSERT_TRUE(ros::param::get("/desert_sim/data_dir", folder_));
  }
  SaveCheckpoint::Response save(const std::string& name) {
    SaveCheckpoint::Request request;
    request.name = name;
    return call<SaveCheckpoint>("save_checkpoint", request);
  }
  LoadCheckpoint::Response load(const std::string& name) {
    LoadCheckpoint::Request request;
    request.name = name;
    return call<LoadCheckpoint>("load_checkpoint", request);
  }
  std::string folder_;
};

TEST_F(Checkpoints, LoadingGoesOnAsIfNothingHadBeen) {
  step(5);
  const SaveCheckpoint::Response saved = save("runs/five.ckpt");
  ASSERT_TRUE(saved.success) << saved.message;
  EXPECT_EQ(saved.step, 5u);
  EXPECT_EQ(saved.state_hash, hash());
  EXPECT_TRUE(fs::exists(folder_ + "/runs/five.ckpt"));
  const std::string later = step(5).state_hash;
  Listener<ElevationGrid> keyframes("elevation");
  keyframes.last();
  const LoadCheckpoint::Response loaded = load("runs/five.ckpt");
  ASSERT_TRUE(loaded.success) << loaded.message;
  EXPECT_EQ(loaded.step, 5u);
  EXPECT_EQ(loaded.sim_time, 5);
  EXPECT_EQ(loaded.state_hash, saved.state_hash);
  EXPECT_TRUE(wait_until([&] { return keyframes.last().step == 5; })) << "a new keyframe after loading";
  EXPECT_EQ(step(5).state_hash, later);
}

TEST_F(Checkpoints, StayBelowTheDataFolder) {
  ASSERT_TRUE(save("here.ckpt").success);
  const fs::path outside = folder_ + "_outside";
  fs::create_directories(outside);
  fs::remove(folder_ + "/leads_out");
  fs::create_symlink(outside, folder_ + "/leads_out");
  fs::remove(folder_ + "/file_out");
  fs::create_symlink(outside / "x.ckpt", folder_ + "/file_out");
  for (const std::string& name :
       {std::string(""), folder_ + "/here.ckpt", std::string("../x.ckpt"), std::string("a/../../x.ckpt"),
        std::string("leads_out/x.ckpt"), std::string("leads_out/deeper/x.ckpt"), std::string("file_out"),
        std::string("folder/"), std::string("."), std::string("..")}) {
    SaveCheckpoint::Request request;
    request.name = name;
    expect_refused<SaveCheckpoint>("save_checkpoint", request, "'" + name + "'", "");
    LoadCheckpoint::Request load_request;
    load_request.name = name;
    expect_refused<LoadCheckpoint>("load_checkpoint", load_request, "'" + name + "'", "");
  }
  EXPECT_TRUE(fs::is_empty(outside));
  fs::remove_all(outside);
}

TEST_F(Checkpoints, LinksThatStayInsideAreFollowed) {
  ASSERT_TRUE(save("real/a.ckpt").success);
  fs::remove(folder_ + "/alias");
  fs::create_symlink(folder_ + "/real", folder_ + "/alias");
  EXPECT_TRUE(load("alias/a.ckpt").success);
}

TEST_F(Checkpoints, BrokenFilesAreRefused) {
  LoadCheckpoint::Request request;
  request.name = "missing.ckpt";
  expect_refused<LoadCheckpoint>("load_checkpoint", request, "missing.ckpt", "no such file");
  ASSERT_TRUE(save("short.ckpt").success);
  fs::resize_file(folder_ + "/short.ckpt", fs::file_size(folder_ + "/short.ckpt") / 2);
  request.name = "short.ckpt";
  expect_refused<LoadCheckpoint>("load_checkpoint", request, "short.ckpt", "truncated");
  request.name = "real";
  fs::create_directories(folder_ + "/real");
  expect_refused<LoadCheckpoint>("load_checkpoint", request, "'real'", "not a file");
}

}  // namespace

int main(int argc, char** argv) {
  const int status = node_test::run_tests(argc, argv, "checkpoints");
  std::string folder;
  if (ros::param::get("/desert_sim/data_dir", folder)) fs::remove_all(folder);
  return status;
}
