#pragma once
/// Fits parameters with NLopt: a global search within the ranges, then a local one from the best point. Both
/// need no derivatives.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace desert_sim {

/// A parameter by its path, as in --set, and the range in which it is looked for.
struct FittedParameter {
  std::string path;
  double lowest = 0, highest = 0;
};

/// `text`: PATH=LOWEST..HIGHEST, with units of time where they suit. Throws ConfigError.
FittedParameter read_fitted_parameter(const std::string& text);

struct SearchPlan {
  std::string global = "direct_l", local = "sbplx";   ///< or "none"
  int global_evaluations = 0, local_evaluations = 0;  ///< at most
  std::uint64_t seed = 1;                             ///< of global searches that draw
  double tolerance = 1e-3;                            ///< of the local search, as a share of each range
};

struct Evaluation {
  std::string stage;           ///< "global" or "local"
  std::vector<double> values;  ///< in the order of the parameters
  double error = 0;
};

/// The best evaluation. `error_of` is what becomes least; `tell` is called after each evaluation. Throws
/// ConfigError for an unknown algorithm, in a build without NLopt, and what `error_of` throws.
Evaluation find_minimum(const std::vector<FittedParameter>& parameters, const SearchPlan& plan,
                        const std::function<double(const std::vector<double>&)>& error_of,
                        const std::function<void(const Evaluation&)>& tell);

/// Names of the algorithms, for a usage.
std::string global_algorithms();
std::string local_algorithms();

}  // namespace desert_sim
