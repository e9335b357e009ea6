#include "src/tools/options.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <locale>
#include <sstream>

#include "src/core/did_you_mean.hpp"
#include "src/core/error.hpp"
#include "src/core/number_text.hpp"

namespace desert_sim {

Options::Options(int argc, char** argv, const std::vector<std::string>& with_value,
                 const std::vector<std::string>& flags) {
  const auto known = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (int n = 1; n < argc; ++n) {
    const std::string argument = argv[n];
    if (argument.rfind("--", 0) != 0) {
      positional_.push_back(argument);
      continue;
    }
    const std::size_t equals = argument.find('=');
    const std::string name = argument.substr(2, equals == std::string::npos ? equals : equals - 2);
    if (known(flags, name) && equals == std::string::npos) {
      values_[name];
    } else if (known(with_value, name)) {
      if (equals == std::string::npos && n + 1 >= argc) throw ConfigError("--" + name + ": needs a value");
      const std::string value = equals == std::string::npos ? argv[++n] : argument.substr(equals + 1);
      if (value.empty()) throw ConfigError("--" + name + " '': needs a value that is not empty");
      values_[name].push_back(value);
    } else {
      std::string all;
      for (const auto& names : {with_value, flags})
        for (const std::string& one : names) all += (all.empty() ? "--" : ", --") + one;
      throw ConfigError(argument + ": unknown option (--help lists them)" + did_you_mean("--" + name, all));
    }
  }
}

std::string Options::text(const std::string& name, const std::string& default_value) const {
  const auto found = values_.find(name);
  return found == values_.end() || found->second.empty() ? default_value : found->second.back();
}

const std::vector<std::string>& Options::values(const std::string& name) const {
  static const std::vector<std::string> none;
  const auto found = values_.find(name);
  return found == values_.end() ? none : found->second;
}

long long Options::number(const std::string& name, long long default_value, long long lowest,
                          long long highest) const {
  const std::string value = text(name, "");
  if (value.empty()) return default_value;
  char* end = nullptr;
  errno = 0;
  const long long number = std::strtoll(value.c_str(), &end, 10);
  if (*end || errno || number < lowest || number > highest)
    throw ConfigError("--" + name + " " + value + ": must be a whole number from " + std::to_string(lowest) +
                      " to " + std::to_string(highest));
  return number;
}

double Options::real(const std::string& name, double default_value, double lowest, double highest) const {
  const std::string value = text(name, "");
  if (value.empty()) return default_value;
  std::istringstream in(value);
  in.imbue(std::locale::classic());
  double number = 0;
  std::string more;
  if (!(in >> number) || (in >> more) || !(number >= lowest && number <= highest))
    throw ConfigError("--" + name + " " + value + ": must be a number from " + number_text(lowest) + " to " +
                      number_text(highest));
  return number;
}

}  // namespace desert_sim
