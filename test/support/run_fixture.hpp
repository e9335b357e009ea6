#pragma once
/// A fixture for tests of desert_run.

#include <gtest/gtest.h>

#include <filesystem>

#include "test/support/program.hpp"
#include "test/support/temporary_folder.hpp"

namespace desert_sim::test {

#ifndef DESERT_RUN_BINARY
#define DESERT_RUN_BINARY ""
#endif

class DesertRun : public ::testing::Test {
 protected:
  void SetUp() override {
    program_ = program_path("DESERT_RUN_BINARY", DESERT_RUN_BINARY);
    ASSERT_TRUE(std::filesystem::exists(program_)) << "no desert_run at '" << program_ << "'";
    scenario_ = folder_.write("small.yaml",
                              "grid: {width: 40, height: 24, cell_size: 2, origin_x: 1000, origin_y: -300}\n"
                              "terrain:\n  - noise: {layer: bedrock, low: 0, high: 6, scale: 20}\n"
                              "  - noise: {layer: sand, low: 0.5, high: 3}\n"
                              "wind: {speed: 6, direction_deg: 30}\nrun: {steps: 12}\n");
  }
  ProgramRun run(const std::vector<std::string>& arguments, const std::vector<Signal>& signals = {}) {
    return run_program(program_, arguments, signals);
  }
  /// On the CPU, quietly, on one thread unless the arguments say else.
  ProgramRun run_cpu(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"--threads", "1"});
    arguments.insert(arguments.end(), {"--backend", "cpu", "--quiet"});
    const ProgramRun r = run(arguments);
    EXPECT_EQ(r.status, 0) << r.err;
    return r;
  }
  std::string path(const std::string& name) const { return folder_.path(name); }

  /// The text of a value in a JSON object, by key; empty if it is not there.
  static std::string json(const std::string& text, const std::string& key) {
    const std::size_t at = text.find("\"" + key + "\": ");
    if (at == std::string::npos) return "";
    const std::size_t begin = at + key.size() + 4;
    return text.substr(begin, text.find_first_of(",\n}", begin) - begin);
  }
  std::string summary(const std::string& out) const { return file_bytes(path(out) + "/summary.json"); }
  std::string hash(const std::string& out) const { return json(summary(out), "state_hash"); }

  TemporaryFolder folder_;
  std::string program_, scenario_;
};

}  // namespace desert_sim::test
