#pragma once
/// Runs one of the package's programs as a user would.

#include <chrono>
#include <string>
#include <vector>

namespace desert_sim::test {

struct ProgramRun {
  int status = -1;       ///< exit status; 128 + signal if one ended it
  std::string out, err;  ///< what it wrote
  double seconds = 0;
  double resident_bytes = 0;  ///< most memory it had; at least that of the test when it began
};

/// Path of the program: the environment variable `variable` if it is set, else `built`.
std::string program_path(const char* variable, const std::string& built);

/// `signal_after` > 0: sends SIGINT after so many seconds.
ProgramRun run_program(const std::string& program, const std::vector<std::string>& arguments,
                       double signal_after = 0);

}  // namespace desert_sim::test
