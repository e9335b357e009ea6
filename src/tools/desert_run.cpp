/// desert_run: runs a scenario without ROS and without a window.
#include <omp.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <iostream>

#include "src/core/error.hpp"
#include "src/simulation/checkpoint.hpp"
#include "src/simulation/session.hpp"
#include "src/tools/drawing.hpp"
#include "src/tools/options.hpp"
#include "src/tools/outputs.hpp"
#include "src/tools/progress.hpp"
#include "src/tools/rasters.hpp"

using namespace desert_sim;

namespace {

const char usage[] =
    "usage: desert_run SCENARIO.yaml [options]\n"
    "  --steps N             steps to run (default: the scenario's run.steps); with --resume: the last step\n"
    "  --backend B           auto (default), cpu or cuda\n"
    "  --threads N           threads of the CPU backend\n"
    "  --set PATH=VALUE      override a key of the scenario; may be repeated\n"
    "  --seed S              same as --set seed=S\n"
    "  --all-raster-formats  read rasters of every format that GDAL reads, also what names other files or "
    "hosts\n"
    "                        (VRT, WMS, /vsi paths), not only GeoTIFF, ESRI ASCII, ENVI, PNG, EXR and USGS "
    "DEM\n"
    "  --out DIR             write rasters, pictures and summary.json to DIR, which is created if needed\n"
    "  --every N             also write them every N steps, to DIR/step_NNNNNNNN\n"
    "  --plot FILE           draw a PNG of areas by material and plants by species over these steps (needs\n"
    "                        python3 with matplotlib)\n"
    "  --checkpoint FILE     save the state to FILE at the end\n"
    "  --checkpoint-every N  also save it every N steps\n"
    "  --resume FILE         start from a checkpoint (of any scenario; SCENARIO may be omitted)\n"
    "  --replay JOURNAL      apply the commands of a journal; without --steps, run as many steps as it has\n"
    "  --describe            print all parameters as markdown\n"
    "  --describe-processes  print the table of processes as markdown\n"
    "  --pipeline            print the processes of a step of the scenario in order, with layers and memory\n"
    "  --quiet               print no progress\n"
    "Exit status: 0; 1 if a material was lost or gained; 2 for invalid input; 3 for a failure at run time;\n"
    "130 after Ctrl-C. Outputs are written except for 2 and 3.\n";

volatile std::sig_atomic_t interrupted = 0;
void interrupt(int) { interrupted = 1; }

struct RunPlan {
  Options options;
  std::string out, checkpoint;
  std::vector<std::string> summaries;  ///< paths of the summaries written during the run
  std::uint64_t every = 0, checkpoint_every = 0;
};

Scenario scenario_of(const Options& o) {
  if (o.positional().size() > 1)
    throw ConfigError("'" + o.positional()[1] + "': only one scenario can be run");
  if (o.positional().empty()) throw ConfigError("no scenario given (--help shows the usage)");
  Settings settings = o.values("set");
  if (o.has("seed")) settings.push_back("seed=" + o.text("seed", ""));
  return load_scenario(o.positional()[0], settings);
}

/// The processes are timed in one of this many steps, because on a GPU a timed step synchronises after each
/// process.
constexpr std::uint64_t timed_every = 16;

void time_processes(Simulation& simulation, bool timed, RunReport& report) {
  if (report.timed != &simulation) report.timed_steps = 0;  // a reset or load has replaced the simulation
  report.timed = &simulation;
  simulation.set_timing(timed);
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
      session.apply(journal.entries[next].command);
  };
  Progress progress(session.ticks(), last, plan.options.has("quiet"));
  Clock::duration stepping{};
  replay();
  while (session.ticks() < last && !interrupted) {
    const auto start = Clock::now();
    const bool timed = report.steps_run % timed_every == 0;
    time_processes(session.simulation(), timed, report);
    session.step();
    if (session.ticks() == last || session.ticks() % 64 == 0) session.simulation().exec().synchronise();
    stepping += Clock::now() - start;
    ++report.steps_run;
    report.milliseconds = std::chrono::duration<double, std::milli>(stepping).count();
    replay();
    const std::uint64_t step = session.simulation().steps();
    if (plan.every && step % plan.every == 0) {
      char name[32];
      std::snprintf(name, sizeof name, "/step_%08llu", static_cast<unsigned long long>(step));
      create_output_folder(plan.out + name);
      write_outputs(plan.out + name, session.simulation(), report);
      plan.summaries.push_back(plan.out + name + "/summary.json");
    }
    if (plan.checkpoint_every && step % plan.checkpoint_every == 0) session.save_checkpoint(plan.checkpoint);
    progress.at(session.ticks());
  }
  session.simulation().exec().synchronise();
}

int run_program(int argc, char** argv) {
  RunPlan plan{Options(argc, argv,
                       {"steps", "backend", "threads", "set", "seed", "out", "every", "plot", "checkpoint",
                        "checkpoint-every", "resume", "replay"},
                       {"all-raster-formats", "describe", "describe-processes", "pipeline", "quiet", "help"}),
               "",
               "",
               {},
               0,
               0};
  const Options& o = plan.options;
  if (o.has("help")) return std::fputs(usage, stdout), 0;
  if (o.has("describe")) return std::cout << describe_parameters(), 0;
  if (o.has("describe-processes")) return std::cout << describe_processes(process_table()), 0;
  plan.out = o.text("out", "");
  plan.checkpoint = o.text("checkpoint", "");
  plan.every = static_cast<std::uint64_t>(o.number("every", 0, 1, 1LL << 40));
  plan.checkpoint_every = static_cast<std::uint64_t>(o.number("checkpoint-every", 0, 1, 1LL << 40));
  const auto steps = static_cast<std::uint64_t>(o.number("steps", 0, 0, 1LL << 40));
  if (plan.every && plan.out.empty()) throw ConfigError("--every: --out is required too");
  if (o.has("plot") && !plan.every) throw ConfigError("--plot: --out and --every are required too");
  if (plan.checkpoint_every && plan.checkpoint.empty())
    throw ConfigError("--checkpoint-every: --checkpoint is required too");
  const int threads = static_cast<int>(o.number("threads", 0, 1, 4096));
  if (threads > 0) omp_set_num_threads(threads);

  Journal journal;
  if (o.has("replay")) journal = read_journal(o.text("replay", ""));
  const std::string backend = o.text("backend", "auto");
  const RasterLoader rasters = raster_loader(o.has("all-raster-formats"));
  std::unique_ptr<Session> session;
  if (o.has("resume") && o.positional().empty()) {
    session = Session::from_checkpoint(o.text("resume", ""), rasters, backend, threads);
  } else {
    session = std::make_unique<Session>(scenario_of(o), rasters, backend, threads);
    if (o.has("replay")) session->require_journal_of_this_scenario(journal, o.text("replay", ""));
    if (o.has("resume")) session->apply(command::LoadCheckpoint{o.text("resume", ""), 0});
  }
  Simulation& simulation = session->simulation();
  if (o.has("pipeline")) return std::cout << describe_pipeline(simulation.pipeline()), 0;
  if (!plan.out.empty()) create_output_folder(plan.out);
  const std::uint64_t scenario_steps =
      o.has("replay") ? journal.ticks : static_cast<std::uint64_t>(simulation.scenario().run.steps);
  const std::uint64_t asked = o.has("steps") ? steps : scenario_steps;
  // A resumed run continues until the requested step.
  const std::uint64_t last =
      o.has("resume") ? (asked > simulation.steps() ? asked - simulation.steps() : 0) : asked;
  if (!o.has("quiet"))
    std::fprintf(stderr, "backend: %s; %s\n", session->backend_choice().c_str(),
                 simulation.exec().device().c_str());

  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
  RunReport report;
  report.backend = simulation.exec().backend();
  report.device = simulation.exec().device();
  if (const auto* cpu = dynamic_cast<CpuExec*>(&simulation.exec())) report.threads = cpu->threads();
  run(*session, plan, journal, last, report);
  if (!plan.out.empty()) write_outputs(plan.out, session->simulation(), report);
  if (o.has("plot") && !plan.summaries.empty())
    run_plot_script("--plot", "plot_run.py", o.text("plot", ""), plan.summaries);
  if (!plan.checkpoint.empty()) session->save_checkpoint(plan.checkpoint);
  if (plan.out.empty() && !o.has("quiet")) std::cout << summary(session->simulation(), report);
  const std::string missing = conservation_error(session->simulation().balance());
  if (!missing.empty())
    return std::fprintf(stderr, "desert_run: material is not conserved: %s\n", missing.c_str()), 1;
  return interrupted ? 130 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run_program(argc, argv);
  } catch (const ConfigError& e) {
    std::fprintf(stderr, "desert_run: %s\n", e.what());
    return 2;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "desert_run: the host has not enough memory\n");
    return 3;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "desert_run: %s\n", e.what());
    return 3;
  }
}
