#include "src/tools/calibration.hpp"

#include <algorithm>
#include <exception>
#include <limits>

#include "src/core/did_you_mean.hpp"
#include "src/core/error.hpp"
#include "src/core/time_units.hpp"

#if DESERT_WITH_NLOPT
#include <nlopt.h>
#endif

namespace desert_sim {

FittedParameter read_fitted_parameter(const std::string& text) {
  const std::string what = "--fit " + text;
  const std::size_t equals = text.find('='), dots = text.find("..");
  if (equals == 0 || equals == std::string::npos || dots == std::string::npos || dots < equals)
    throw ConfigError(what + ": must be PATH=LOWEST..HIGHEST");
  FittedParameter p;
  p.path = text.substr(0, equals);
  p.lowest = read_time(text.substr(equals + 1, dots - equals - 1), what + ":", -1e12, 1e12);
  p.highest = read_time(text.substr(dots + 2), what + ":", -1e12, 1e12);
  if (!(p.lowest < p.highest)) throw ConfigError(what + ": the lowest value must be below the highest");
  return p;
}

#if DESERT_WITH_NLOPT

namespace {

struct Algorithm {
  const char* name;
  nlopt_algorithm id;
};
constexpr Algorithm global_searches[] = {{"direct_l", NLOPT_GN_DIRECT_L},
                                         {"crs2", NLOPT_GN_CRS2_LM},
                                         {"isres", NLOPT_GN_ISRES},
                                         {"esch", NLOPT_GN_ESCH}};
constexpr Algorithm local_searches[] = {{"sbplx", NLOPT_LN_SBPLX},
                                        {"bobyqa", NLOPT_LN_BOBYQA},
                                        {"cobyla", NLOPT_LN_COBYLA},
                                        {"nelder_mead", NLOPT_LN_NELDERMEAD}};

template <std::size_t count>
std::string names_of(const Algorithm (&algorithms)[count]) {
  std::string names;
  for (const Algorithm& a : algorithms) names += std::string(a.name) + ", ";
  return names + "none";
}

template <std::size_t count>
nlopt_algorithm find(const Algorithm (&algorithms)[count], const std::string& option,
                     const std::string& name) {
  for (const Algorithm& a : algorithms)
    if (name == a.name) return a.id;
  throw ConfigError(option + ": " + not_one_of(name, names_of(algorithms)));
}

/// A search that calls back. Points are shares of the ranges.
class Search {
 public:
  Search(const std::vector<FittedParameter>& parameters,
         const std::function<double(const std::vector<double>&)>& error_of,
         const std::function<void(const Evaluation&)>& tell)
      : parameters_(parameters), error_of_(error_of), tell_(tell) {
    best.error = std::numeric_limits<double>::infinity();
  }

  void run(const char* stage, nlopt_algorithm algorithm, int evaluations, double tolerance) {
    stage_ = stage;
    const auto count = static_cast<unsigned>(parameters_.size());
    optimiser_ = nlopt_create(algorithm, count);
    nlopt_set_lower_bounds1(optimiser_, 0);
    nlopt_set_upper_bounds1(optimiser_, 1);
    nlopt_set_min_objective(optimiser_, &Search::evaluate, this);
    nlopt_set_maxeval(optimiser_, evaluations);
    if (tolerance > 0) nlopt_set_xtol_abs1(optimiser_, tolerance);
    if (tolerance > 0) nlopt_set_initial_step1(optimiser_, 0.1);
    std::vector<double> point = shares;
    double least = 0;
    const nlopt_result result = nlopt_optimize(optimiser_, point.data(), &least);
    nlopt_destroy(optimiser_);
    if (fault_) std::rethrow_exception(fault_);
    // Where rounding ends a search, its best point counts all the same.
    if (result < 0 && result != NLOPT_ROUNDOFF_LIMITED)
      throw ConfigError(std::string("the ") + stage + " search cannot begin with " + std::to_string(count) +
                        " parameters (NLopt says " + std::to_string(result) +
                        "); allowed: another algorithm");
  }

  Evaluation best;
  std::vector<double> shares;  ///< of the best evaluation, or where to begin

 private:
  static double evaluate(unsigned count, const double* point, double*, void* self) {
    return static_cast<Search*>(self)->evaluate(count, point);
  }
  double evaluate(unsigned count, const double* point) {
    try {  // nothing may be thrown through NLopt
      Evaluation e{stage_, {}, 0};
      for (unsigned n = 0; n < count; ++n) {
        const FittedParameter& p = parameters_[n];
        e.values.push_back(p.lowest + std::clamp(point[n], 0.0, 1.0) * (p.highest - p.lowest));
      }
      e.error = error_of_(e.values);
      if (e.error < best.error) {
        best = e;
        shares.assign(point, point + count);
      }
      tell_(e);
      return e.error;
    } catch (...) {
      fault_ = std::current_exception();
      nlopt_force_stop(optimiser_);
      return std::numeric_limits<double>::max();
    }
  }

  const std::vector<FittedParameter>& parameters_;
  const std::function<double(const std::vector<double>&)>& error_of_;
  const std::function<void(const Evaluation&)>& tell_;
  std::string stage_;
  nlopt_opt optimiser_ = nullptr;
  std::exception_ptr fault_;
};

}  // namespace

std::string global_algorithms() { return names_of(global_searches); }
std::string local_algorithms() { return names_of(local_searches); }

Evaluation find_minimum(const std::vector<FittedParameter>& parameters, const SearchPlan& plan,
                        const std::function<double(const std::vector<double>&)>& error_of,
                        const std::function<void(const Evaluation&)>& tell) {
  const bool globally = plan.global != "none", locally = plan.local != "none";
  if (!globally && !locally) throw ConfigError("--global none, --local none: one of them must search");
  const nlopt_algorithm global =
                            globally ? find(global_searches, "--global", plan.global) : NLOPT_GN_DIRECT_L,
                        local = locally ? find(local_searches, "--local", plan.local) : NLOPT_LN_SBPLX;
  Search search(parameters, error_of, tell);
  search.shares.assign(parameters.size(), 0.5);
  nlopt_srand(static_cast<unsigned long>(plan.seed));
  if (globally) search.run("global", global, plan.global_evaluations, 0);
  if (locally) search.run("local", local, plan.local_evaluations, plan.tolerance);
  return search.best;
}

#else

std::string global_algorithms() { return "none: this build has no NLopt"; }
std::string local_algorithms() { return "none: this build has no NLopt"; }

Evaluation find_minimum(const std::vector<FittedParameter>&, const SearchPlan&,
                        const std::function<double(const std::vector<double>&)>&,
                        const std::function<void(const Evaluation&)>&) {
  throw ConfigError("this build cannot calibrate (it was built without libnlopt-dev)");
}

#endif

}  // namespace desert_sim
