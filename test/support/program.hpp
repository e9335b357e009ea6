#pragma once
/// Runs one of the package's programs as a user would.

#include <functional>
#include <string>
#include <vector>

namespace desert_sim::test {

struct ProgramRun {
  int status = -1;            ///< exit status; 128 + signal if one ended it
  std::string out, err;       ///< what it wrote
  double resident_bytes = 0;  ///< most memory it had; at least that of the test when it began
};

/// A signal that is sent, to the program and those that it has started, as a terminal does, as soon as `when`
/// is true of what the program has written to its standard error so far.
struct Signal {
  int number;
  std::function<bool(const std::string& err)> when;
};

/// Path of the program: the environment variable `variable` if it is set, else `built`.
std::string program_path(const char* variable, const std::string& built);

/// Runs it until it ends. The signals are sent one after the other.
ProgramRun run_program(const std::string& program, const std::vector<std::string>& arguments,
                       const std::vector<Signal>& signals = {});

}  // namespace desert_sim::test
