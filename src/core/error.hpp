#pragma once
/// Exception classes. Library code throws them and neither exits nor prints. The message names the place, the
/// error and the values concerned.

#include <stdexcept>
#include <string>

namespace desert_sim {

/// Messages hold at most so many bytes, because what they quote can come from a file or a request of any
/// size.
constexpr std::size_t max_message_size = 2000;

/// `message`, cut to max_message_size bytes; what is left out is said at its end.
inline std::string limited_message(const std::string& message) {
  if (message.size() <= max_message_size) return message;
  constexpr std::size_t kept = max_message_size - 60;
  return message.substr(0, kept) + " ... (" + std::to_string(message.size() - kept) +
         " more bytes are left out)";
}

class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message) : std::runtime_error(limited_message(message)) {}
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
