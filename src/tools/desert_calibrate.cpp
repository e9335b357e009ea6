/// desert_calibrate: fits parameters of a scenario to the measured change of a terrain.
#include <omp.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "src/command_line/program.hpp"
#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/core/number_text.hpp"
#include "src/scenario/scenario_file.hpp"
#include "src/scenario/sections.hpp"
#include "src/simulation/session.hpp"
#include "src/tools/calibration.hpp"
#include "src/tools/rasters.hpp"
#include "src/tools/run_length.hpp"

using namespace desert_sim;

namespace {

Options options() {
  Options o(
      "desert_calibrate",
      "Fits parameters of a scenario to the measured change of a terrain: they become those with which the "
      "root mean square of the difference between the simulated and the measured change of elevation is "
      "least, over all cells.");
  o.positional("SCENARIO", "as for desert_run; it begins with the terrain of the first measurement")
      .option("after", "DEM", "a raster of the elevation measured at the end of the run; required")
      .required()
      .option("before", "DEM", "that at its beginning (default: the elevation of the scenario)")
      .option("fit", "PATH=A..B", "a parameter to fit, and its range; required; may be repeated")
      .required()
      .option("out", "FILE", "the scenario with the fitted parameters; required")
      .required()
      .option("steps", "N", "as for desert_run")
      .option("duration", "T", "as for desert_run")
      .excludes("steps")
      .option("table", "FILE", "a line for each evaluation (CSV)")
      .option("global", "NAME", "direct_l (default), crs2, isres, esch or none")
      .option("global-evaluations", "N", "at most (default 20 for each parameter, and 20 more)")
      .option("local", "NAME", "sbplx (default), bobyqa, cobyla, nelder_mead or none")
      .option("local-evaluations", "N", "at most (default as many)")
      .option("set", "PATH=VALUE", "as for desert_run")
      .option("backend", "B", "as for desert_run")
      .option("threads", "N", "as for desert_run")
      .flag("quiet", "print no progress")
      .footer("Exit status: 0; 2 for invalid input; 3 for a failure at run time.");
  return o;
}

std::vector<float> elevation_of(Session& session) {
  return session.simulation().views().snapshot({Layer::elevation})->layers.at(Layer::elevation);
}

/// A measured elevation on the grid of the scenario.
std::vector<float> load_measured(const std::string& path, const GridParameters& grid) {
  RasterRequest request;
  request.path = path;
  request.width = grid.width;
  request.height = grid.height;
  request.cell_size = grid.cell_size;
  request.origin_x = grid.origin_x;
  request.origin_y = grid.origin_y;
  return raster_loader()(request).values;
}

/// Runs the scenario with given values, and compares.
class Comparison {
 public:
  Comparison(const Options& o, std::vector<FittedParameter> parameters)
      : options_(o),
        path_(scenario_argument(o.positional().at(0))),
        threads_(static_cast<int>(o.number("threads", 0, 1, 4096))),
        parameters_(std::move(parameters)) {
    if (threads_ > 0) omp_set_num_threads(threads_);
    std::vector<double> middle;
    for (const FittedParameter& p : parameters_) middle.push_back(0.5 * (p.lowest + p.highest));
    const auto session = begin(middle);
    const GridParameters& grid = session->simulation().scenario().grid;
    const std::vector<float> after = load_measured(o.text("after", ""), grid),
                             before = o.has("before") ? load_measured(o.text("before", ""), grid)
                                                      : elevation_of(*session);
    for (std::size_t i = 0; i < after.size(); ++i)
      measured_.push_back(static_cast<double>(after[i]) - static_cast<double>(before[i]));
  }

  /// Root mean square of what the simulated change differs from the measured one [m].
  double error(const std::vector<double>& values) {
    const auto session = begin(values);
    const std::vector<float> before = elevation_of(*session);
    const auto usual = static_cast<std::uint64_t>(session->simulation().scenario().run.steps);
    for (std::uint64_t left = steps_to_run(options_, session->simulation(), usual); left > 0; --left)
      session->step();
    const std::vector<float> after = elevation_of(*session);
    double sum = 0;
    for (std::size_t i = 0; i < after.size(); ++i) {
      const double change = static_cast<double>(after[i]) - static_cast<double>(before[i]);
      sum += (change - measured_[i]) * (change - measured_[i]);
    }
    return std::sqrt(sum / static_cast<double>(after.size()));
  }

  /// The scenario with these values as a file that can lie anywhere.
  std::string fitted(const std::vector<double>& values) {
    Scenario s = begin(values)->simulation().state().start;
    const auto absolute = [&s](std::string& file) {
      if (!file.empty()) file = std::filesystem::absolute(raster_path(s, file)).string();
    };
    absolute(s.grid.from_raster);
    absolute(s.wind_regime.series_file);
    for (TerrainStep& step : s.terrain)
      if (auto* raster = std::get_if<RasterStep>(&step)) absolute(raster->file);
    return dump_scenario(s) + "\n";
  }

 private:
  std::unique_ptr<Session> begin(const std::vector<double>& values) {
    Settings settings = options_.values("set");
    for (std::size_t n = 0; n < values.size(); ++n)
      settings.push_back(parameters_[n].path + "=" + number_text(values[n], 9));
    Scenario scenario = load_scenario(path_, settings);
    scenario.wind_series = series_;
    auto session =
        std::make_unique<Session>(scenario, raster_loader(), options_.text("backend", "auto"), threads_);
    series_ = session->simulation().state().start.wind_series;
    return session;
  }

  const Options& options_;
  std::string path_;
  int threads_;
  std::vector<FittedParameter> parameters_;
  std::vector<double> measured_;                ///< change of elevation [m]
  std::shared_ptr<const WindSeries> series_{};  ///< read once
};

/// The table and the progress of the evaluations.
class Report {
 public:
  Report(const std::vector<FittedParameter>& parameters, std::string path, bool quiet)
      : parameters_(parameters), path_(std::move(path)), quiet_(quiet), table_("evaluation,stage") {
    for (const FittedParameter& p : parameters_) table_ += "," + p.path;
    table_ += ",rms_m,best_rms_m\n";
  }
  void add(const Evaluation& e) {
    best_ = count_++ == 0 ? e.error : std::min(best_, e.error);
    table_ += std::to_string(count_) + "," + e.stage;
    for (double value : e.values) table_ += "," + number_text(value, 9);
    table_ += "," + number_text(e.error, 9) + "," + number_text(best_, 9) + "\n";
    if (!path_.empty()) write_file(path_, table_);
    if (quiet_) return;
    std::fprintf(stderr, "%4d %s: rms %.4g m (best %.4g m)", count_, e.stage.c_str(), e.error, best_);
    for (std::size_t n = 0; n < e.values.size(); ++n)
      std::fprintf(stderr, "  %s=%.6g", parameters_[n].path.c_str(), e.values[n]);
    std::fputc('\n', stderr);
  }

 private:
  const std::vector<FittedParameter>& parameters_;
  std::string path_;
  bool quiet_;
  std::string table_;
  double best_ = 0;
  int count_ = 0;
};

int run_program(const Options& o) {
  check_run_length(o);
  std::vector<FittedParameter> parameters;
  for (const std::string& fit : o.values("fit")) parameters.push_back(read_fitted_parameter(fit));
  SearchPlan plan;
  const auto usual = static_cast<long long>(20 * (parameters.size() + 1));
  plan.global = o.text("global", plan.global);
  plan.local = o.text("local", plan.local);
  plan.global_evaluations = static_cast<int>(o.number("global-evaluations", usual, 1, 1000000));
  plan.local_evaluations = static_cast<int>(o.number("local-evaluations", usual, 1, 1000000));
  for (const char* file : {"out", "table"})
    if (o.has(file)) require_writable_file(o.text(file, ""));

  Comparison comparison(o, parameters);
  Report report(parameters, o.text("table", ""), o.has("quiet"));
  const Evaluation best = find_minimum(
      parameters, plan, [&](const std::vector<double>& values) { return comparison.error(values); },
      [&](const Evaluation& e) { report.add(e); });
  write_file(o.text("out", ""), comparison.fitted(best.values));
  std::printf("rms %.6g m\n", best.error);
  for (std::size_t n = 0; n < parameters.size(); ++n)
    std::printf("%s: %.9g\n", parameters[n].path.c_str(), best.values[n]);
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return run_main(options(), argc, argv, run_program); }
