#pragma once

#include <string>
#include <vector>

namespace desert_sim {

/// While it lives, GDAL's messages of this thread are kept here instead of going to stderr. Registers GDAL's
/// drivers. Not copyable; instances nest.
class GdalMessages {
 public:
  GdalMessages();
  ~GdalMessages();
  GdalMessages(const GdalMessages&) = delete;
  GdalMessages& operator=(const GdalMessages&) = delete;

  /// True once GDAL reported a failure, not just a warning.
  bool failed() const { return failures_ > 0; }
  /// The failures, or else the warnings, on one line; "no reason given" if there are none.
  std::string text() const;
  void clear();
  /// Called by GDAL's error handler.
  void add(bool failure, const char* message);

 private:
  int failures_ = 0;
  std::vector<std::string> failure_texts_, warning_texts_;
};

}  // namespace desert_sim
