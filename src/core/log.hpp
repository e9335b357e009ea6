#pragma once
/// Where libraries say what they cannot throw, from destructors above all. They never print by themselves.

#include <functional>
#include <iostream>
#include <mutex>
#include <string>
#include <utility>

namespace desert_sim {

namespace detail {
inline std::mutex log_mutex;
inline std::function<void(const std::string&)> log_sink = [](const std::string& message) {
  std::cerr << "desert_sim: " << message << std::endl;
};
}  // namespace detail

/// From any thread. Goes to the standard error unless set_log_sink() has been called.
inline void log_error(const std::string& message) {
  const std::lock_guard<std::mutex> lock(detail::log_mutex);
  detail::log_sink(message);
}

/// The program's own log, which is called by whoever logs, on its thread, one at a time.
inline void set_log_sink(std::function<void(const std::string& message)> sink) {
  const std::lock_guard<std::mutex> lock(detail::log_mutex);
  detail::log_sink = std::move(sink);
}

}  // namespace desert_sim
