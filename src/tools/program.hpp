#pragma once
/// What the main() of every program has in common.

#include <functional>

namespace desert_sim {

/// Calls `body` and returns the exit status of the program: that of `body`, 2 if it throws ConfigError, 3 if
/// it throws anything else or if the standard output could not be written. Errors are printed to stderr after
/// `name`.
///
/// Before that, a program that was started without OMP_WAIT_POLICY is executed anew with the value `passive`,
/// as in launch/desert_sim.launch: threads that wait for others then leave the processor to other programs.
/// OpenMP reads the variable before main() begins.
int run_main(const char* name, char** argv, const std::function<int()>& body);

}  // namespace desert_sim
