#pragma once
/// GDAL's warnings and errors as text.

#include <string>
#include <vector>

namespace desert_sim {

/// Collects GDAL's messages of the current thread during its lifetime, instead of their being printed to
/// stderr. The constructor registers GDAL's drivers. Instances can be nested.
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
