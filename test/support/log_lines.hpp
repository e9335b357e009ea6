#pragma once
/// What is logged meanwhile.

#include <string>
#include <vector>

#include "src/core/log.hpp"

namespace desert_sim::test {

class LogLines {
 public:
  LogLines()
      : before_(set_log_sink([this](Severity, const std::string& message) { lines.push_back(message); })) {}
  ~LogLines() { set_log_sink(before_); }
  LogLines(const LogLines&) = delete;
  LogLines& operator=(const LogLines&) = delete;

  std::vector<std::string> lines;

 private:
  LogSink before_;
};

}  // namespace desert_sim::test
