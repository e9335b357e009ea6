#pragma once
/// Command lines: options with and without values, refused with a reason when they are unknown or malformed.

#include <map>
#include <string>
#include <vector>

namespace desert_sim {

class Options {
 public:
  /// `with_value` and `flags` name what is known, without the dashes. Throws ConfigError.
  Options(int argc, char** argv, const std::vector<std::string>& with_value,
          const std::vector<std::string>& flags);

  const std::vector<std::string>& positional() const { return positional_; }
  bool has(const std::string& name) const { return values_.count(name) > 0; }
  std::string text(const std::string& name, const std::string& otherwise) const;
  const std::vector<std::string>& all(const std::string& name) const;
  /// A whole number in [lowest, highest]; throws ConfigError.
  long long number(const std::string& name, long long otherwise, long long lowest, long long highest) const;

 private:
  std::map<std::string, std::vector<std::string>> values_;
  std::vector<std::string> positional_;
};

}  // namespace desert_sim
