#pragma once
/// Exception classes. Library code throws them and neither exits nor prints. The message names the place, the
/// error and the values concerned.

#include <stdexcept>
#include <string>

namespace desert_sim {

class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Invalid input: a scenario, raster, command or checkpoint. Nothing has been changed when it is thrown.
class ConfigError : public Error {
 public:
  using Error::Error;
};

/// A failure of the GPU or its driver. CUDA errors are sticky: every later call fails too, so the process
/// should report the error and exit.
class CudaError : public Error {
 public:
  using Error::Error;
};

/// The terrain's state violates an invariant of a layer (a negative depth, NaN). The message names the
/// process, the layer and the cell.
class StateError : public Error {
 public:
  using Error::Error;
};

/// A file cannot be written although its path is valid: the disk is full or broken. What there was before is
/// unchanged, and a simulation can go on.
class WriteError : public Error {
 public:
  using Error::Error;
};

}  // namespace desert_sim
