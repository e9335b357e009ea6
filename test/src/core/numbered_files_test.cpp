// Files that a program numbers: the newest is what was saved last, whatever names others have chosen.

#include "src/core/numbered_files.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "test/support/temporary_folder.hpp"

namespace desert_sim {
namespace {

namespace fs = std::filesystem;

class Numbered : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path(name); }
  /// Saves a file that is newer than all, and returns its path.
  std::string save() const { return folder_.write(files_.next_name(), ""); }

  const test::TemporaryFolder folder_;
  const NumberedFiles files_{folder_.path(""), "node-0123-", ".ckpt"};
};

TEST_F(Numbered, AreNoneWithoutAFolder) {
  const NumberedFiles none(path("no such folder"), "a-", ".ckpt");
  EXPECT_TRUE(none.paths().empty());
  EXPECT_EQ(none.next_name(), "a-0000000001.ckpt");
  none.keep_newest(0);
}

TEST_F(Numbered, AreNewestFirstAndTheNewestAreKept) {
  std::vector<std::string> saved;
  for (int n = 0; n < 12; ++n) saved.insert(saved.begin(), save());
  EXPECT_EQ(fs::path(saved.front()).filename(), "node-0123-0000000012.ckpt");
  ASSERT_EQ(files_.paths().size(), saved.size());
  for (std::size_t n = 0; n < saved.size(); ++n)
    EXPECT_TRUE(fs::equivalent(files_.paths()[n], saved[n])) << n;
  files_.keep_newest(2);
  EXPECT_EQ(files_.paths().size(), 2u);
  EXPECT_TRUE(fs::exists(saved[0]) && fs::exists(saved[1]));
}

TEST_F(Numbered, NeededOnesAreKept) {
  std::vector<std::string> saved;
  for (int n = 0; n < 4; ++n) saved.push_back(save());
  fs::create_directory_symlink(folder_.path("."), folder_.path("link"));
  files_.keep_newest(1, {saved[1], path("link/") + fs::path(saved[2]).filename().string(), path("gone")});
  EXPECT_FALSE(fs::exists(saved[0]));
  for (int n = 1; n < 4; ++n) EXPECT_TRUE(fs::exists(saved[static_cast<std::size_t>(n)])) << n;
}

TEST_F(Numbered, AChosenNameDoesNotWinOverWhatIsSavedLater) {
  for (const char* chosen : {"9999999999", "99999999999999999999999", "zzz", "", "00000000000000099", "-1",
                             "18446744073709551615", "1e99", "99999999999999999999999.ckpt"}) {
    SCOPED_TRACE(chosen);
    save();
    folder_.write(std::string("node-0123-") + chosen + ".ckpt", "");
    for (int n = 0; n < 3; ++n) {
      const std::string saved = save();
      files_.keep_newest(2);
      ASSERT_TRUE(fs::exists(saved));
      EXPECT_TRUE(fs::equivalent(files_.paths().front(), saved)) << files_.paths().front();
    }
  }
}

TEST_F(Numbered, OthersFilesStayAndThoseOfKilledWritersGo) {
  const std::vector<std::string> others = {"node-0123-.ckpt", "node-0123-1.ckpt", "node-4567-0000000003.ckpt",
                                           ".node-4567-0000000003.ckpt.00ff.part"};
  for (const std::string& name : others) folder_.write(name, "");
  folder_.write(".node-0123-0000000001.ckpt.0123456789abcdef.part", "half");
  fs::create_directory(path("node-0123-0000000007.ckpt"));
  fs::create_symlink(path("node-0123-1.ckpt"), path("node-0123-0000000009.ckpt"));
  EXPECT_TRUE(files_.paths().empty()) << "no regular files";
  files_.keep_newest(0);
  for (const std::string& name : others) EXPECT_TRUE(fs::exists(path(name))) << name;
  EXPECT_TRUE(fs::is_directory(path("node-0123-0000000007.ckpt")));
  EXPECT_FALSE(fs::exists(path(".node-0123-0000000001.ckpt.0123456789abcdef.part")));
}

}  // namespace
}  // namespace desert_sim
