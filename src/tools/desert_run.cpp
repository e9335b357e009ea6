/// desert_run: runs a scenario without ROS and without a window.
#include <omp.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <optional>
#include <set>

#include "src/command_line/program.hpp"
#include "src/core/did_you_mean.hpp"
#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/export/export_formats.hpp"
#include "src/scenario/former_keys.hpp"
#include "src/scenario/raster_grid.hpp"
#include "src/scenario/scenario_file.hpp"
#include "src/simulation/checkpoint.hpp"
#include "src/simulation/session.hpp"
#if DESERT_WITH_IO
#include "src/io/projection.hpp"
#endif
#include "src/tools/certify.hpp"
#include "src/tools/drawing.hpp"
#include "src/tools/film.hpp"
#include "src/tools/micro_relief_output.hpp"
#include "src/tools/outputs.hpp"
#include "src/tools/progress.hpp"
#include "src/tools/rasters.hpp"
#include "src/tools/run_length.hpp"
#include "src/tools/run_options.hpp"
#include "src/tools/terrain_series.hpp"

using namespace desert_sim;

namespace {

volatile std::sig_atomic_t interrupted = 0;
void interrupt(int) { interrupted = 1; }

/// Ctrl-C, a request to end, and the loss of the terminal end the run after its step; under nohup, the last
/// does not.
void catch_signals() {
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
  if (std::signal(SIGHUP, interrupt) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

struct RunPlan {
  const Options& options;
  std::string out, checkpoint;
  std::vector<std::string> exports;    ///< files of --export
  std::vector<std::string> summaries;  ///< paths of the summaries written during the run
  std::uint64_t every = 0, checkpoint_every = 0;
  std::unique_ptr<Film> film;
  std::uint64_t film_every = 0;
  Measurements measurements;
  std::vector<MicroReliefWindow> details;
  std::unique_ptr<TerrainSeries> series;  ///< of --format netcdf
};

RunPlan plan_of(const Options& o) {
  RunPlan plan{o, "", "", {}, {}, 0, 0, nullptr, 0, {}, {}, nullptr};
  plan.out = o.text("out", "");
  plan.checkpoint = o.text("checkpoint", "");
  plan.exports = o.values("export");
  for (const std::string& file : plan.exports) export_format(file);
  plan.checkpoint_every = static_cast<std::uint64_t>(o.number("checkpoint-every", 0, 1, 1LL << 40));
  const std::string format = o.text("format", "geotiff");
  if (format != "geotiff" && format != "netcdf")
    throw ConfigError("--format: " + not_one_of(format, "geotiff, netcdf"));
  if (o.has("plot") && format == "netcdf")
    throw ConfigError("--plot: needs the summaries of --format geotiff");
  plan.every = snapshot_distance(o, 0);
  o.number("probe-every", 1, 1, 1LL << 40);
  if (o.has("plot") && !plan.every) throw ConfigError("--plot requires --every or --snapshots");
  check_run_length(o);
  if (o.has("film-every") && Film::is_picture(o.text("film", "")))
    throw ConfigError("--film-every: --film " + o.text("film", "") +
                      " is one picture, of the end (allowed with .mp4 or a folder)");
  return plan;
}

Settings settings_of(const Options& o) {
  Settings settings = o.values("set");
  if (o.has("seed")) settings.push_back("seed=" + o.text("seed", ""));
  return settings;
}

void migrate(const std::string& path) {
  const std::string before = read_file(path), now = migrated(before, path);
  if (now != before) write_file(path, now);
  std::cout << path << (now == before ? ": has no former keys\n" : ": is rewritten\n");
}

/// A session at the start of the scenario.
std::unique_ptr<Session> begin_session(const Options& o, const Journal& journal, int threads) {
  if (o.positional().empty()) throw ConfigError("no scenario given (--help shows the usage)");
  Scenario scenario = load_scenario(scenario_argument(o.positional()[0]), settings_of(o));
  if (o.has("script")) add_script(scenario, o.text("script", ""));
  auto session = std::make_unique<Session>(scenario, raster_loader(o.has("all-raster-formats")),
                                           o.text("backend", "auto"), threads, "", journal.undo_memory);
  if (o.has("replay")) session->require_journal_of_this_scenario(journal, o.text("replay", ""));
  if (journal.version < 3) session->undo_edits_alone();
  return session;
}

/// A session at the state of the checkpoint of --resume, with the parameters of --set.
std::unique_ptr<Session> resume_session(const Options& o, const Journal& journal, int threads) {
  const std::string checkpoint = o.text("resume", "");
  std::unique_ptr<Session> session;
  if (o.positional().empty()) {
    session = Session::from_checkpoint(checkpoint, raster_loader(o.has("all-raster-formats")),
                                       o.text("backend", "auto"), threads, journal.undo_memory);
    if (journal.version < 3) session->undo_edits_alone();
  } else {
    session = begin_session(o, journal, threads);
    session->apply(command::LoadCheckpoint{checkpoint, 0});
  }
  const Settings settings = settings_of(o);
  if (!settings.empty()) session->apply(command::SetParameters{settings});
  return session;
}

/// A checkpoint must not replace what the run reads, or what its journal needs when it is replayed again. The
/// checkpoint of --resume alone may be replaced by its continuation.
void require_no_input_replaced(const RunPlan& plan, const Journal& journal) {
  const Options& o = plan.options;
  const auto require_other = [&plan](const std::string& input, const char* what) {
    if (same_file(plan.checkpoint, input))
      throw ConfigError("--checkpoint " + plan.checkpoint + ": would replace " + what + " (" + input +
                        "; allowed: another file)");
  };
  for (const std::string& scenario : o.positional())
    require_other(scenario_argument(scenario), "the scenario");
  if (!o.has("replay")) return;
  require_other(o.text("replay", ""), "the journal");
  if (o.has("resume")) require_other(o.text("resume", ""), "the checkpoint that the replay begins with");
  for (const std::string& checkpoint : checkpoints_of(journal))
    require_other(checkpoint, "a checkpoint that the journal loads");
}

/// Of --export: refuses what could not be written, what another one writes, and what the run reads.
void require_exports(const RunPlan& plan, const Scenario& scenario) {
  std::vector<std::string> inputs = raster_paths(scenario);
  for (const std::string& name : plan.options.positional()) inputs.push_back(scenario_argument(name));
  std::set<std::string> written;
  for (const std::string& file : plan.exports) {
    require_exportable(file, scenario.grid.width, scenario.grid.height, inputs);
    for (const std::string& name : exported_files(file))
      if (!written.insert(name).second) throw ConfigError("--export " + name + ": is written twice");
  }
}

/// About 250 pictures, ten seconds of a film.
std::uint64_t usual_film_every(std::uint64_t steps) { return std::max<std::uint64_t>(1, steps / 250); }

/// Before the first step: refuses files that could not be written at the end. Creates the folders of --out
/// and --film. `steps`: how many there will be.
void prepare_outputs(RunPlan& plan, const Journal& journal, std::uint64_t steps, Simulation& simulation) {
  if (!plan.checkpoint.empty()) require_no_input_replaced(plan, journal);
#if DESERT_WITH_IO
  if (!plan.out.empty() && !simulation.scenario().projection.empty())
    require_projection_database("--out " + plan.out);
#endif
  const std::string created = plan.out.empty() ? "" : create_output_folder(plan.out);
  try {
    if (!plan.checkpoint.empty()) require_writable_file(plan.checkpoint);
    require_exports(plan, simulation.scenario());
    if (plan.options.text("format", "") == "netcdf")
      plan.series = std::make_unique<TerrainSeries>(plan.out + "/terrain.nc", simulation);
    if (plan.options.has("plot")) require_writable_file(plan.options.text("plot", ""));
    if (plan.options.has("film")) {
      plan.film =
          std::make_unique<Film>(plan.options.text("film", ""), view_parameters(plan.options.values("view")));
      const auto usual = static_cast<long long>(usual_film_every(steps));
      plan.film_every = static_cast<std::uint64_t>(plan.options.number("film-every", usual, 1, 1LL << 40));
    }
  } catch (...) {
    if (!created.empty()) remove_empty_folders(created, plan.out);
    throw;
  }
}

/// The processes are timed in one of this many steps, because on a GPU a timed step synchronises after each
/// process.
constexpr std::uint64_t timed_every = 16;

void time_processes(Simulation& simulation, bool timed, RunReport& report) {
  if (report.timed != &simulation) report.timed_steps = 0;  // a reset or load has replaced the simulation
  report.timed = &simulation;
  simulation.pipeline().set_timing(timed);
  if (!timed) return;
  simulation.exec().synchronise();
  ++report.timed_steps;
}

/// Runs the session until tick `last` and applies the journal's commands at their ticks.
void run(Session& session, RunPlan& plan, const Journal& journal, std::uint64_t last, RunReport& report) {
  using Clock = std::chrono::steady_clock;
  std::size_t next = 0;
  const auto replay = [&] {
    for (; next < journal.entries.size() && journal.entries[next].tick == session.ticks(); ++next)
      session.replay(journal.entries[next].command);
  };
  Progress progress(session.ticks(), last, plan.options.has("quiet"));
  Clock::duration stepping{};
  replay();
  if (plan.film) plan.film->add(session.simulation());
  while (session.ticks() < last && !interrupted) {
    const auto start = Clock::now();
    const bool timed = report.steps_run % timed_every == 0;
    time_processes(session.simulation(), timed, report);
    plan.measurements.keep_flux(session);
    const double before = session.simulation().time();
    session.step();
    if (session.ticks() == last || session.ticks() % 64 == 0) session.simulation().exec().synchronise();
    stepping += Clock::now() - start;
    ++report.steps_run;
    plan.measurements.add(session.simulation(), session.simulation().time() - before);
    report.milliseconds = std::chrono::duration<double, std::milli>(stepping).count();
    replay();
    const std::uint64_t step = session.simulation().steps();
    if (plan.every && step % plan.every == 0 && plan.series) {
      plan.series->add(session.simulation());
    } else if (plan.every && step % plan.every == 0) {
      char name[32];
      std::snprintf(name, sizeof name, "/step_%08llu", static_cast<unsigned long long>(step));
      create_output_folder(plan.out + name);
      write_outputs(plan.out + name, session.simulation(), report);
      write_micro_relief(plan.out + name, session.simulation(), plan.details);
      plan.summaries.push_back(plan.out + name + "/summary.json");
    }
    if (plan.film && (session.ticks() % plan.film_every == 0 || session.ticks() == last))
      plan.film->add(session.simulation());
    if (plan.checkpoint_every && step % plan.checkpoint_every == 0) session.save_checkpoint(plan.checkpoint);
    progress.at(session.ticks());
  }
  session.simulation().exec().synchronise();
}

/// What is printed instead of a run.
std::optional<std::string> page_of(const Options& o) {
  if (o.has("describe")) return describe_parameters();
  if (o.has("describe-view")) return describe_view();
  if (o.has("describe-processes")) return describe_processes(process_table());
  return std::nullopt;
}

int run_program(const Options& o) {
  if (o.has("certify")) return certify(o);
  RunPlan plan = plan_of(o);
  if (const std::optional<std::string> page = page_of(o)) {
    std::cout << *page;
    return 0;
  }
  if (o.has("migrate")) {
    migrate(o.text("migrate", ""));
    return 0;
  }
  const int threads = static_cast<int>(o.number("threads", 0, 1, 4096));
  if (threads > 0) omp_set_num_threads(threads);

  Journal journal;
  if (o.has("replay")) journal = read_journal(o.text("replay", ""));
  const std::unique_ptr<Session> session =
      o.has("resume") ? resume_session(o, journal, threads) : begin_session(o, journal, threads);
  Simulation& simulation = session->simulation();
  const std::uint64_t last = steps_to_run(
      o, simulation,
      o.has("replay") ? journal.ticks : static_cast<std::uint64_t>(simulation.scenario().run.steps));
  if (o.has("pipeline")) {
    std::cout << describe_pipeline(simulation.pipeline()) << "\nA run takes " << last << " steps of "
              << simulation.scenario().run.time_step << " s.\n";
    return 0;
  }
  plan.every = snapshot_distance(o, last);
  plan.measurements = Measurements(o.values("cross-section"), o.values("probe"),
                                   static_cast<std::uint64_t>(o.number("probe-every", 1, 1, 1LL << 40)),
                                   simulation.scenario());
  plan.details = micro_relief_windows(o.values("micro-relief"), simulation.scenario().grid);
  prepare_outputs(plan, journal, last, simulation);
  if (!o.has("quiet"))
    std::fprintf(stderr, "backend: %s; %s\n", session->backend_choice().c_str(),
                 simulation.exec().device_name().c_str());

  catch_signals();
  RunReport report;
  report.measurements = &plan.measurements;
  report.backend = simulation.exec().backend();
  report.device = simulation.exec().device_name();
  if (const auto* cpu = dynamic_cast<CpuExec*>(&simulation.exec())) report.threads = cpu->threads();
  run(*session, plan, journal, last, report);
  if (plan.series) plan.series->add(session->simulation());
  if (!plan.out.empty()) write_outputs(plan.out, session->simulation(), report, !plan.series);
  if (!plan.out.empty()) write_micro_relief(plan.out, session->simulation(), plan.details);
  if (o.has("probe")) write_file(plan.out + "/probes.csv", plan.measurements.probes().csv());
  if (o.has("plot") && !plan.summaries.empty())
    run_plot_script("--plot", "plot_run.py", o.text("plot", ""), plan.summaries);
  if (plan.film) plan.film->finish(session->simulation());
  if (!plan.exports.empty()) {
    const ExportedTerrain terrain = terrain_to_export(session->simulation());
    for (const std::string& file : plan.exports) export_terrain(file, terrain);
  }
  if (!plan.checkpoint.empty()) session->save_checkpoint(plan.checkpoint);
  if (plan.out.empty() && !o.has("quiet")) std::cout << summary(session->simulation(), report);
  const std::string missing = conservation_error(session->simulation().state().balance());
  if (!missing.empty()) {
    std::fprintf(stderr, "desert_run: material is not conserved: %s\n", missing.c_str());
    return 1;
  }
  return interrupted ? 130 : 0;
}

}  // namespace

int main(int argc, char** argv) { return run_main(run_options(), argc, argv, run_program); }
