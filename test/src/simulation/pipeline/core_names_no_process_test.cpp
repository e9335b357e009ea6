// What runs processes knows none of them by name: a new one is a row, and no line here.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

#include "src/simulation/processes/processes.hpp"
#include "test/support/temporary_folder.hpp"

namespace desert_sim {
namespace {

std::vector<std::filesystem::path> sources_of_the_core() {
  const std::filesystem::path room = std::filesystem::path(DESERT_SOURCE_DIR) / "src/simulation";
  std::vector<std::filesystem::path> files;
  for (const char* part : {"pipeline", "state", "memory"})
    for (const auto& entry : std::filesystem::directory_iterator(room / part)) files.push_back(entry.path());
  for (const char* name : {"simulation", "session"})
    for (const char* ending : {".hpp", ".cpp"}) files.push_back(room / (std::string(name) + ending));
  return files;
}

/// Lines that say the name as a text, use its namespace, or include its header. (wind::Vector is a type of
/// everybody's.)
std::vector<std::string> mentions(const std::string& source, const Process& process) {
  const std::string header = std::regex_replace(process.header, std::regex("\\."), "\\.");
  const std::regex mention("\"" + process.name + "\"|\\b" + process.name + "::(?!Vector)|\"" + header + "\"");
  std::vector<std::string> lines;
  std::istringstream text(source);
  for (std::string line; std::getline(text, line);)
    if (std::regex_search(line, mention)) lines.push_back(line);
  return lines;
}

TEST(Core, NamesNoProcess) {
  const auto files = sources_of_the_core();
  ASSERT_GT(files.size(), 18u);
  for (const auto& file : files) {
    const std::string source = test::file_bytes(file.string());
    ASSERT_FALSE(source.empty()) << file;
    for (const Process& process : process_table().processes)
      for (const std::string& line : mentions(source, process)) ADD_FAILURE() << file << ": " << line;
  }
}

TEST(Core, MentionsAreFound) {
  Process process;
  process.name = "reptation";
  process.header = "kernels/sand/reptation.hpp";
  for (const char* line :
       {"if (name == \"reptation\")", "reptation::step(e);", "#include \"kernels/sand/reptation.hpp\""})
    EXPECT_EQ(mentions(line, process).size(), 1u) << line;
  EXPECT_TRUE(mentions("// reptation follows", process).empty());
}

}  // namespace
}  // namespace desert_sim
