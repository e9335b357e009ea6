#pragma once
/// Errors. Library code throws these and never exits or prints; the message says where, what and which
/// values.

#include <stdexcept>
#include <string>

namespace desert_sim {

class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Input that is refused: scenario, raster, command, checkpoint. Nothing has been changed when it is thrown.
class ConfigError : public Error {
 public:
  using Error::Error;
};

/// A failure of the GPU or its driver. These are sticky: the process should report and end.
class CudaError : public Error {
 public:
  using Error::Error;
};

/// The terrain's state broke a promise of its layer (negative depth, NaN): names the process, layer and cell.
class StateError : public Error {
 public:
  using Error::Error;
};

}  // namespace desert_sim
