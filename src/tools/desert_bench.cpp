/// desert_bench: measures the time per step of the benchmark scenes. doc/contributing/performance.md has
/// results.
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "kernels/avalanching/avalanching_parameters.hpp"
#include "src/command_line/program.hpp"
#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/simulation/processes/sand_slopes.hpp"
#include "src/tools/bench_report.hpp"
#include "src/tools/bench_scenes.hpp"
#include "src/tools/cost_model.hpp"
#include "src/tools/drawing.hpp"
#include "src/tools/rasters.hpp"

using namespace desert_sim;

namespace {

Options options() {
  Options o("desert_bench", "Measures the time per step of the benchmark scenes.");
  o.positional("RESULT.json", "of --roofline: results of earlier runs", 0, 1000)
      .option("scene", "S",
              "A (barchans, default), B (transverse), mature (A after 2000 steps), edited (mature with a "
              "column of "
              "sand, 50 m high, added), all 1024 m square; or SCENARIO.yaml")
      .option("size", "N", "cells along each side (default 512)")
      .option("steps", "N", "steps to time (default by size), in ten blocks, the first of which is not timed")
      .option("warm-up", "N", "steps before these (default 2000 for mature and edited, else 0)")
      .option("start", "FILE", "start from a checkpoint of the scene, without a warm-up")
      .excludes("warm-up")
      .option("save-start", "FILE", "save the state after the warm-up to FILE, for --start")
      .option("backend", "B", "auto (default), cpu or cuda")
      .option("threads", "N", "threads of the CPU backend")
      .option("quality", "Q", "fast, good or converged (default: the scenario's)")
      .option("set", "PATH=VALUE", "override a key of the scenario; may be repeated")
      .option("json", "FILE",
              "write the result to FILE (-: print it instead of text); doc/contributing/performance.md "
              "describes its fields")
      .option(
          "roofline", "FILE",
          "draw a picture of bytes per cell against milliseconds for the given JSON results or for this run "
          "(needs python3 with matplotlib)")
      .flag("cost-model", "print the least memory traffic per cell of each process, as a markdown table")
      .footer("Exit status: 0; 1 if sand was lost; 2 for invalid input; 3 for a failure at\nrun time.");
  return o;
}

constexpr int blocks = 10;

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::duration d) { return std::chrono::duration<double, std::milli>(d).count(); }

int default_steps(int size, bool gpu) {
  if (!gpu) return size <= 512 ? 100 : 20;
  return size <= 1024 ? 1000 : (size <= 2048 ? 600 : (size <= 4096 ? 200 : (size <= 8192 ? 40 : 20)));
}

/// Bandwidth of a large copy, read and written [bytes/s].
double measure_copy_bandwidth(Exec& exec) {
  const std::size_t most = exec.device() == Device::cpu ? std::size_t{1} << 28 : std::size_t{1} << 30;
  const std::size_t bytes = std::min(most, exec.memory_available() / 8);
  Buffer<char> from(exec, bytes), to(exec, bytes);
  from.set_zero();
  to.set_zero();
  std::vector<double> times;
  for (int n = 0; n < 5; ++n) {
    exec.synchronise();
    const auto start = Clock::now();
    exec.copy(to.data(), from.data(), bytes);
    exec.synchronise();
    times.push_back(milliseconds(Clock::now() - start));
  }
  std::sort(times.begin(), times.end());
  return 2.0 * static_cast<double>(bytes) / (times[times.size() / 2] * 1e-3);
}

Settings settings_of(const Options& o) {
  Settings settings = o.values("set");
  if (o.has("quality")) settings.push_back("avalanching.quality=" + o.text("quality", ""));
  return settings;
}

/// A session from the checkpoint of --start, with the parameters that other options set.
std::unique_ptr<Session> resume_session(const Options& o, const std::string& scene, int threads) {
  const std::string path = o.text("start", "");
  auto session = Session::from_checkpoint(path, raster_loader(), o.text("backend", "auto"), threads);
  const Scenario& found = session->simulation().scenario();
  const std::string wanted = bench_scenario(scene, found.grid.width, {}).name;
  if (found.name != wanted)
    throw ConfigError("--start " + path + ": is a checkpoint of the scene " + found.name + ", not of " +
                      wanted);
  const long long size = o.number("size", found.grid.width, 16, 65536);
  if (size != found.grid.width)
    throw ConfigError("--size " + std::to_string(size) + ": the checkpoint of --start " + path +
                      " has the size " + std::to_string(found.grid.width));
  const Settings settings = settings_of(o);
  if (!settings.empty()) session->apply(command::SetParameters{settings});
  return session;
}

/// A session at the state from which timing starts.
std::unique_ptr<Session> prepare_session(const Options& o, const std::string& scene, int threads) {
  if (o.has("start")) return resume_session(o, scene, threads);
  const int size = static_cast<int>(o.number("size", 512, 16, 65536));
  auto session = std::make_unique<Session>(bench_scenario(scene, size, settings_of(o)), raster_loader(),
                                           o.text("backend", "auto"), threads);
  const long long warm_up = o.number("warm-up", default_warm_up_steps(scene), 0, 1000000);
  for (long long n = 0; n < warm_up; ++n) session->step();
  return session;
}

/// Milliseconds per step in each block of `count` steps, without the first block.
std::vector<double> time_blocks(Session& session, int count) {
  Exec& exec = session.simulation().exec();
  std::vector<double> times;
  for (int block = 0; block < blocks; ++block) {
    exec.synchronise();
    const auto start = Clock::now();
    for (int n = 0; n < count; ++n) session.step();
    exec.synchronise();
    if (block > 0) times.push_back(milliseconds(Clock::now() - start) / count);
  }
  return times;
}

std::vector<BenchReport::Process> time_processes(Session& session, int steps) {
  Simulation& s = session.simulation();
  const std::vector<ProcessCost> model = cost_model(s.scenario(), s.terrain().grid());
  s.exec().synchronise();
  s.pipeline().set_timing(true);
  for (int n = 0; n < steps; ++n) session.step();
  s.pipeline().set_timing(false);
  std::vector<BenchReport::Process> processes;
  for (const ProcessTime& t : s.pipeline().times())
    processes.push_back({t.process, t.milliseconds / steps, min_bytes(model, t.process)});
  return processes;
}

BenchReport bench(const Options& o) {
  BenchReport r;
  const std::string scene = o.text("scene", "A");
  const int threads = static_cast<int>(o.number("threads", 0, 1, 4096));
  if (threads > 0) omp_set_num_threads(threads);
  const auto session = prepare_session(o, scene, threads);
  Simulation& s = session->simulation();
  if (o.has("save-start")) session->save_checkpoint(o.text("save-start", ""));

  r.scene = is_bench_scene(scene) ? scene : s.scenario().name;
  r.backend = s.exec().backend();
  r.device = s.exec().device_name();
  r.quality = avalanche_qualities[static_cast<int>(s.scenario().get<AvalanchingParameters>().quality)];
  if (const auto* cpu = dynamic_cast<CpuExec*>(&s.exec())) r.threads = cpu->threads();
  r.width = s.terrain().grid().width;
  r.height = s.terrain().grid().height;
  r.cell_size = s.scenario().grid.cell_size;
  r.warm_up = s.steps();
  const long long steps = o.number("steps", default_steps(r.width, r.threads == 0), blocks, 1000000);
  const int count = static_cast<int>(steps) / blocks;
  r.steps = blocks * count;

  if (scene == "edited") session->apply(bench_edit(s.scenario().grid));
  r.block_times_ms = time_blocks(*session, count);
  r.residual = sand_residual(s.state(), s.pipeline());
  r.fine_sweeps = s.pipeline().mean_count(avalanche_iterations);
  r.memory = s.memory();
  r.processes = time_processes(*session, std::max(3, r.steps / 20));
  r.sand = s.state().balance()[static_cast<std::size_t>(Material::sand)];
  r.copy_bandwidth = measure_copy_bandwidth(s.exec());
  return r;
}

int run_program(const Options& o) {
  if (o.has("cost-model")) {
    std::fputs(cost_table().c_str(), stdout);
    return 0;
  }
  const std::string picture = o.text("roofline", "");
  if (!o.positional().empty()) {
    if (picture.empty())
      throw ConfigError("'" + o.positional()[0] + "': unexpected argument (--help shows the usage)");
    require_writable_file(picture);
    run_plot_script("--roofline", "roofline.py", picture, o.positional());
    return 0;
  }
  const std::string json = o.text("json", "");
  if (!picture.empty() && (json.empty() || json == "-"))
    throw ConfigError("--roofline " + picture +
                      ": needs JSON results, or --json FILE for the result of this run");
  if (!json.empty() && json != "-") require_writable_file(json);
  if (!picture.empty()) require_writable_file(picture);
  if (o.has("save-start")) require_writable_file(o.text("save-start", ""));
  const BenchReport report = bench(o);
  std::fputs((json == "-" ? bench_json(report) : bench_text(report)).c_str(), stdout);
  if (!json.empty() && json != "-") write_file(json, bench_json(report));
  if (!picture.empty()) run_plot_script("--roofline", "roofline.py", picture, {json});
  if (report.sand.residual() == 0) return 0;
  std::fprintf(stderr, "desert_bench: %lld quanta of sand were lost\n", -report.sand.residual());
  return 1;
}

}  // namespace

int main(int argc, char** argv) { return run_main(options(), argc, argv, run_program); }
