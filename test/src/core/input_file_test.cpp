// What may be opened, below the data folder and elsewhere, and by which names.

#include "src/core/input_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <filesystem>
#include <thread>

#include "src/core/data_folder.hpp"
#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/scenario/scenario.hpp"
#include "test/support/refusal.hpp"
#include "test/support/temporary_folder.hpp"

namespace desert_sim {
namespace {

namespace fs = std::filesystem;
using test::refusal;

void expect_says(const std::string& message, const std::string& part) {
  EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
}

class InputFiles : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_.path("data/deep")); }
  std::string data() const { return folder_.path("data"); }
  std::string read(const std::string& name) const { return read_file(data() + "/" + name, data()); }

  const test::TemporaryFolder folder_;
};

TEST_F(InputFiles, AreReadBelowTheFolderOnly) {
  folder_.write("data/a", "inside");
  folder_.write("secret", "outside");
  EXPECT_EQ(read("a"), "inside");
  EXPECT_EQ(read("deep/../a"), "inside");
  expect_says(refusal([&] { read("../secret"); }), "is not below");
  expect_says(refusal([&] { read_file("/etc/passwd", data()); }), "is not below");
  expect_says(refusal([&] { read_file("/no/such/file", data()); }), "is not below");
  expect_says(refusal([&] { read("missing"); }), "no such file exists");
  EXPECT_EQ(read_file(folder_.path("secret")), "outside") << "without a folder, any file is read";
}

TEST_F(InputFiles, FollowLinksInsideTheFolderAndNoneThatLeadOut) {
  folder_.write("data/a", "inside");
  folder_.write("secret", "outside");
  fs::create_symlink(folder_.path("data/a"), folder_.path("data/inner"));
  fs::create_symlink(folder_.path("secret"), folder_.path("data/outer"));
  fs::create_directory_symlink(folder_.path("."), folder_.path("data/deep/up"));
  EXPECT_EQ(read("inner"), "inside");
  expect_says(refusal([&] { read("outer"); }), "is not below");
  expect_says(refusal([&] { read("deep/up/secret"); }), "is not below");
}

TEST_F(InputFiles, ThatAreMissingHaveNamesThatAreNear) {
  folder_.write("data/deep/terrain-bedrock-1.tif", "");
  folder_.write("secret", "outside");
  const auto reason = [this](const std::string& name) { return refusal([&] { read(name); }); };
  expect_says(reason("deep/terrain-bedrok-1.tif"),
              "no such file exists; did you mean 'terrain-bedrock-1.tif'?");
  expect_says(reason("deep/bedrock.tif"), "did you mean 'terrain-bedrock-1.tif'?");
  expect_says(reason("dep/bedrock.tif"), "did you mean 'deep'?");
  EXPECT_EQ(reason("deep/b.tif").find("did you mean"), std::string::npos);
  expect_says(refusal([&] { DataFolder(data()).for_reading("deep/bedrock"); }),
              "did you mean 'terrain-bedrock-1.tif'?");
  // As a scenario names it which does not lie beside it:
  const std::string relative = refusal([&] { read_file("deep/bedrock.tif", data()); });
  expect_says(relative, "'deep/bedrock.tif': no such file exists below " + fs::canonical(data()).string());
  expect_says(relative, "did you mean 'terrain-bedrock-1.tif'?");
  EXPECT_EQ(refusal([&] { read_file("../secrets", data()); }).find("did you mean"), std::string::npos);
  EXPECT_EQ(reason("../secrets").find("did you mean"), std::string::npos) << "what lies outside is not told";
}

/// Swaps a file and a link that leads out as fast as it can while the file is opened again and again, until
/// it was read and refused often enough.
TEST_F(InputFiles, ALinkThatIsSwappedInMeanwhileIsNotFollowed) {
  folder_.write("secret", "outside");
  const std::string name = folder_.path("data/deep/a"), file = folder_.path("data/file"),
                    link = folder_.path("data/link");
  std::atomic<bool> done{false};
  std::thread attacker([&] {
    for (bool as_link = false; !done; as_link = !as_link) {
      const std::string next = as_link ? link : file;
      if (as_link)
        fs::create_symlink(folder_.path("secret"), next);
      else
        folder_.write("data/file", "inside");
      fs::rename(next, name);
    }
  });
  constexpr int often = 1000;
  int times_read = 0, times_refused = 0;
  while (times_read < often || times_refused < often) {
    try {
      EXPECT_EQ(read("deep/a"), "inside");
      ++times_read;
    } catch (const ConfigError&) {  // the name was missing, or a link
      ++times_refused;
    }
  }
  done = true;
  attacker.join();
}

TEST_F(InputFiles, KeepWhatWasOpened) {
  folder_.write("data/a", "first");
  const InputFile file(data() + "/a", data());
  folder_.write("data/b", "second");
  fs::rename(folder_.path("data/b"), folder_.path("data/a"));
  EXPECT_EQ(file.read_all(), "first");
  EXPECT_EQ(test::file_bytes(file.descriptor_path()), "first");
}

/// Nobody writes to the FIFO, and /dev/zero does not end: reading either of them would take for ever.
TEST_F(InputFiles, WhatIsNoRegularFileIsRefusedAtOnce) {
  ASSERT_EQ(mkfifo(folder_.path("data/fifo").c_str(), 0600), 0);
  for (const std::string& folder : {std::string(), data()}) {
    expect_says(refusal([&] { read_file(folder_.path("data/fifo"), folder); }), "is not a regular file");
    expect_says(refusal([&] { read_file(folder_.path("data/deep"), folder); }), "is not a regular file");
    expect_says(refusal([&] { load_scenario(folder_.path("data/fifo"), {}, folder); }),
                "is not a regular file");
  }
  expect_says(refusal([] { read_file("/dev/zero"); }), "is not a regular file");
}

/// Opening the FIFO would take for ever.
TEST_F(InputFiles, AScenarioBesideAFifoLooksForItsRasterWithoutWaiting) {
  ASSERT_EQ(mkfifo(folder_.path("data/dem.tif").c_str(), 0600), 0);
  const Scenario s = load_scenario(folder_.write("data/s.yaml", "grid: {from_raster: dem.tif}\n"));
  EXPECT_EQ(raster_paths(s), std::vector<std::string>{folder_.path("data/dem.tif")});
}

TEST_F(InputFiles, AScenarioHasALargestSize) {
  const std::string path = folder_.write("data/s.yaml", "grid: {width: 8}\n");
  fs::resize_file(path, (std::uintmax_t{1} << 24) + 1);
  expect_says(refusal([&] { load_scenario(path); }), "16777217 bytes (allowed: at most 16777216)");
}

TEST_F(InputFiles, AFolderThatIsReplacedByALinkDoesNotLeadWritersElsewhere) {
  const DataFolder files(data());
  fs::create_directory(folder_.path("elsewhere"));
  const WritableFile file = files.for_writing("saved/a/b.txt");
  EXPECT_EQ(file.path(), fs::canonical(data()).string() + "/saved/a/b.txt");
  fs::rename(folder_.path("data/saved"), folder_.path("data/moved"));
  fs::create_directory(folder_.path("elsewhere/a"));
  fs::create_directory_symlink(folder_.path("elsewhere"), folder_.path("data/saved"));
  file.write([](const std::string& path) { write_file(path, "bytes"); });
  EXPECT_EQ(test::file_bytes(folder_.path("data/moved/a/b.txt")), "bytes");
  EXPECT_TRUE(fs::is_empty(folder_.path("elsewhere/a")));
  expect_says(refusal([&] { files.for_writing("saved/a/b.txt"); }), "points outside the folder");
  expect_says(refusal([&] { files.for_writing("saved/new/b.txt"); }), "points outside the folder");
  EXPECT_FALSE(fs::exists(folder_.path("elsewhere/new")));
}

TEST_F(InputFiles, WhatCannotBeWrittenIsToldByItsKnownPath) {
  const DataFolder files(data());
  const WritableFile file = files.for_writing("saved/b.txt");
  fs::create_directory(folder_.path("data/saved/b.txt"));
  const std::string reason =
      refusal([&] { file.write([](const std::string& path) { write_file(path, "bytes"); }); });
  expect_says(reason, fs::canonical(data()).string() + "/saved/b.txt: cannot be written: is a folder");
  EXPECT_EQ(reason.find("/proc"), std::string::npos) << reason;
  fs::create_symlink(folder_.path("gone"), folder_.path("data/saved/c.txt"));
  expect_says(refusal([&] { files.for_writing("saved/c.txt"); }), "is a symbolic link that leads nowhere");
}

TEST_F(InputFiles, NamesAreCheckedBeforeTheDiskIsAsked) {
  const DataFolder files(data());
  folder_.write("data/a", "inside");
  EXPECT_EQ(files.for_reading("a"), fs::canonical(folder_.path("data/a")).string());
  const std::string deep = "1/2/3/4/5/6/7/8/9/10/11/12/13/14/15/16/a", deeper = "0/" + deep;
  EXPECT_NE(files.for_writing(deep).path(), "");
  for (const auto& [name, reason] : std::vector<std::pair<std::string, std::string>>{
           {"", "is empty"},
           {"/etc/passwd", "is absolute"},
           {"../secret", "contains '..'"},
           {"deep/", "names no file"},
           {deeper, "lies 17 folders deep, at most 16 are allowed"},
           {std::string(256, 'a'), "has 256 characters, at most 255 are allowed"},
           {"a\ngrid: {width: 3}", "contains the control character with the code 10 after 1 others"},
           {std::string("a\0b", 3), "contains the control character with the code 0"},
           {"a\x1b[2J", "contains the control character with the code 27"},
           {"a\x7f", "contains the control character with the code 127"}}) {
    for (const std::string& message :
         {refusal([&] { files.for_reading(name); }), refusal([&] { files.for_writing(name); })}) {
      expect_says(message, reason);
      EXPECT_TRUE(std::none_of(message.begin(), message.end(), [](char c) {
        return c == '\n' || c == '\x1b';
      })) << message;
    }
  }
  EXPECT_FALSE(fs::exists(folder_.path("data/0"))) << "nothing was made";
  std::string thousand;
  for (int n = 0; n < 1000; ++n) thousand += "d/";
  expect_says(refusal([&] { files.for_writing(thousand + "a"); }), "has 2001 characters");
  EXPECT_FALSE(fs::exists(folder_.path("data/d"))) << "nothing was made";
}

}  // namespace
}  // namespace desert_sim
