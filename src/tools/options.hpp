#pragma once
/// Parses command lines: options with and without values. Unknown and malformed ones, and empty values, are
/// refused with a reason.

#include <map>
#include <string>
#include <vector>

namespace desert_sim {

class Options {
 public:
  /// `with_value` and `flags` are the names of the known options, without the dashes. Throws ConfigError.
  Options(int argc, char** argv, const std::vector<std::string>& with_value,
          const std::vector<std::string>& flags);

  const std::vector<std::string>& positional() const { return positional_; }
  bool has(const std::string& name) const { return values_.count(name) > 0; }
  /// The last value of an option, or `default_value` if it was not given.
  std::string text(const std::string& name, const std::string& default_value) const;
  /// All values of an option in order.
  const std::vector<std::string>& values(const std::string& name) const;
  /// The last value as an integer in [lowest, highest], or `default_value` if the option was not given.
  /// Throws ConfigError.
  long long number(const std::string& name, long long default_value, long long lowest,
                   long long highest) const;
  /// Likewise as a number.
  double real(const std::string& name, double default_value, double lowest, double highest) const;

 private:
  std::map<std::string, std::vector<std::string>> values_;
  std::vector<std::string> positional_;
};

}  // namespace desert_sim
