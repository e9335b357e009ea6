#pragma once
/// Where libraries say what they cannot throw: errors, in destructors above all, and warnings. They never
/// print by themselves.

#include <functional>
#include <iostream>
#include <mutex>
#include <string>
#include <utility>

namespace desert_sim {

enum class Severity { warning, error };
using LogSink = std::function<void(Severity severity, const std::string& message)>;

namespace detail {
inline std::mutex log_mutex;
inline LogSink log_sink = [](Severity severity, const std::string& message) {
  std::cerr << "desert_sim: " << (severity == Severity::warning ? "warning: " : "") << message << std::endl;
};
}  // namespace detail

/// From any thread. Goes to the standard error unless set_log_sink() has been called.
inline void log_error(const std::string& message) {
  const std::lock_guard<std::mutex> lock(detail::log_mutex);
  detail::log_sink(Severity::error, message);
}

/// Something in the input that is allowed, but probably not meant. From any thread, as log_error().
inline void log_warning(const std::string& message) {
  const std::lock_guard<std::mutex> lock(detail::log_mutex);
  detail::log_sink(Severity::warning, message);
}

/// The program's own log, which is called by whoever logs, on its thread, one at a time. Returns the one
/// before.
inline LogSink set_log_sink(LogSink sink) {
  const std::lock_guard<std::mutex> lock(detail::log_mutex);
  return std::exchange(detail::log_sink, std::move(sink));
}

}  // namespace desert_sim
