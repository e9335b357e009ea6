// Files that are written: whole or not at all, under a name that nobody can guess, over regular files only.

#include "src/core/files.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <thread>
#include <vector>

#include "src/core/error.hpp"
#include "src/core/temporary_file.hpp"
#include "test/support/full_disk.hpp"
#include "test/support/refusal.hpp"
#include "test/support/temporary_folder.hpp"

namespace desert_sim {
namespace {

namespace fs = std::filesystem;
using test::refusal;

class Files : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path(name); }
  /// The names in the folder, in order.
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path("."))) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

  const test::TemporaryFolder folder_;
};

TEST_F(Files, AreReplacedWhole) {
  write_file(path("a"), "one");
  write_file(path("a"), std::string("\0two", 4));
  EXPECT_EQ(read_file(path("a")), std::string("\0two", 4));
  EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

TEST_F(Files, LinksThatSomebodyHasPlantedAreNotFollowed) {
  folder_.write("victim", "precious");
  fs::create_symlink(path("victim"), path("a.part"));
  write_file(path("a"), "bytes");
  EXPECT_EQ(read_file(path("victim")), "precious");
  EXPECT_EQ(read_file(path("a")), "bytes");
}

TEST_F(Files, HaveAnotherTemporaryNameEachTime) {
  const TemporaryFile one(path("a")), other(path("a"));
  const std::vector<std::string> both = names();
  ASSERT_EQ(both.size(), 2u);
  for (const std::string& name : both) {
    EXPECT_EQ(name.rfind(".a.", 0), 0u) << name;
    EXPECT_EQ(name.size(), std::string(".a.0123456789abcdef.part").size()) << name;
  }
}

TEST_F(Files, WithTheLongestNameAreWritten) {
  const std::string longest(255, 'n');
  write_file(path(longest), "bytes");
  EXPECT_EQ(names(), std::vector<std::string>{longest});
}

TEST_F(Files, ReplaceNothingButRegularFiles) {
  folder_.write("file", "precious");
  fs::create_symlink(path("file"), path("link"));
  fs::create_symlink(path("nowhere"), path("dangling"));
  fs::create_directory(path("folder"));
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  const std::vector<std::string> before = names();
  for (const auto& [name, kind] :
       std::vector<std::pair<std::string, std::string>>{{"link", "a symbolic link"},
                                                        {"dangling", "a symbolic link"},
                                                        {"folder", "a folder"},
                                                        {"pipe", "a pipe"}}) {
    for (const std::string& message : {refusal([&, name = name] { write_file(path(name), "bytes"); }),
                                       refusal([&, name = name] { require_writable_file(path(name)); })}) {
      EXPECT_EQ(message.rfind(path(name) + ": ", 0), 0u) << message;
      EXPECT_NE(message.find(kind), std::string::npos) << message;
    }
  }
  EXPECT_EQ(names(), before);
  EXPECT_TRUE(fs::is_fifo(path("pipe")));
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(read_file(path("file")), "precious");
  // The check alone: whoever can write to /dev would otherwise replace the device in this test.
  EXPECT_NE(refusal([] { require_writable_file("/dev/full"); }).find("/dev/full"), std::string::npos);
}

TEST_F(Files, WithoutANameOrAFolderAreRefused) {
  for (const std::string& name : {std::string(), path(""), path("."), path(".."), path("no/such/file")}) {
    EXPECT_NE(refusal([&] { require_writable_file(name); }).find(name), std::string::npos) << name;
    EXPECT_NE(refusal([&] { write_file(name, "bytes"); }).find(name), std::string::npos) << name;
  }
  require_writable_file(path("free"));
  EXPECT_TRUE(names().empty());
}

TEST_F(Files, OnAFullDiskLeaveNothingAndAreAFailureNotARefusal) {
  folder_.write("a", "old");
  {
    const test::FullDisk disk(1000);
    try {
      write_file(path("a"), std::string(5000, 'x'));
      ADD_FAILURE() << "was written";
    } catch (const WriteError& e) {
      EXPECT_NE(std::string(e.what()).find(path("a")), std::string::npos) << e.what();
    }
  }
  EXPECT_EQ(names(), std::vector<std::string>{"a"});
  EXPECT_EQ(read_file(path("a")), "old");
}

TEST_F(Files, AreTheSameWhateverTheirPathIs) {
  folder_.write("a", "");
  fs::create_directory(path("folder"));
  fs::create_directory_symlink(path("."), path("link"));
  EXPECT_TRUE(same_file(path("a"), path("folder/../a")));
  EXPECT_TRUE(same_file(path("a"), path("link/a")));
  EXPECT_TRUE(same_file(path("free"), path("link/./free")));
  EXPECT_TRUE(same_file("free", fs::current_path() / "free"));
  EXPECT_FALSE(same_file(path("a"), path("free")));
  EXPECT_FALSE(same_file(path("a"), path("folder/a")));
}

TEST_F(Files, AFolderIsLockedByOneAtATime) {
  int inside = 0, most = 0;
  std::vector<std::thread> threads;
  std::mutex mutex;
  for (int n = 0; n < 4; ++n)
    threads.emplace_back([&] {
      for (int turn = 0; turn < 20; ++turn) {
        const FolderLock lock(path("."));
        {
          const std::lock_guard<std::mutex> guard(mutex);
          most = std::max(most, ++inside);
        }
        std::this_thread::yield();
        const std::lock_guard<std::mutex> guard(mutex);
        --inside;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(most, 1);
  EXPECT_THROW(FolderLock(path("no such folder")), ConfigError);
}

}  // namespace
}  // namespace desert_sim
