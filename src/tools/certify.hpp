#pragma once
/// `desert_run --certify`: whether this machine gives the hashes of the certificate.

#include "src/command_line/options.hpp"

namespace desert_sim {

/// Makes the runs of the certificate, several at a time, and prints what differs, what was not run, and where
/// they were made. Returns the exit status: 0 if all hashes of runs that this build can make are those of the
/// certificate, or were recorded, else 1. Throws ConfigError.
int certify(const Options& options);

}  // namespace desert_sim
