/// desert_bench: times the benchmark scenes by size and backend. See test/bench/README.md for what was
/// measured.
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <sstream>

#include "desert_sim/core/error.hpp"
#include "desert_sim/simulation/session.hpp"
#include "desert_sim/tools/options.hpp"
#include "desert_sim/tools/rasters.hpp"

using namespace desert_sim;

namespace {

const char usage[] =
    "usage: desert_bench [--size N] [--scene A|B|SCENARIO.yaml] [options]\n"
    "  --size N        cells a side (default 512); scenes A and B are always 1024 m square\n"
    "  --scene S       A: sand 0.5 + 1.5 U, wind 5 m/s (barchans); B: 3 + 2 U, wind 3 m/s (transverse); or a "
    "file\n"
    "  --steps N       steps to time (default by size); the first tenth is warm-up and not timed\n"
    "  --backend B     auto (default), cpu or cuda\n"
    "  --threads N     threads of the CPU backend\n"
    "  --quality Q     fast, good or converged (default: the scenario's)\n"
    "  --set PATH=VAL  override a key of the scenario; may be repeated\n"
    "  --json          print JSON\n";

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::duration d) { return std::chrono::duration<double, std::milli>(d).count(); }

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

/// Fewest bytes a cell that a process must move through memory: each layer it reads once and each it writes
/// once.
struct ProcessBytes {
  const char* process;
  double bytes;
};
constexpr ProcessBytes fewest_bytes[] = {
    {"wind", 4 * 2 + 4 + 8},            // bedrock, sand; elevation, wind
    {"wind_shadow", 4 + 8 + 4},         // elevation, wind; wind_shadow
    {"echo_dunes", 4 + 8 + 4},          // elevation, wind; echo
    {"saltation", 8 + 8 + 12 + 4 + 4},  // sand and airborne sand both ways; wind, shadow; landed; strength
    {"reptation", 4 + 8 + 4 + 4},       // strength, wind, shadow; repose
    {"avalanching", 4 + 8 + 4},         // bedrock, sand both ways, repose
};

struct Result {
  std::string scene, backend, device, quality;
  int size = 0, threads = 0, steps = 0;
  double cell_size = 0, ms = 0, fastest_ms = 0, slowest_ms = 0, bandwidth = 0;
  std::vector<ProcessTime> processes;
  Residual residual;
  double sand_lost = 0, iterations = 0;
};

Scenario bench_scenario(const std::string& scene, int size, const Settings& settings) {
  if (scene != "A" && scene != "B") {
    Settings all = settings;
    all.push_back("grid.width=" + std::to_string(size));
    all.push_back("grid.height=" + std::to_string(size));
    return load_scenario(scene, all);
  }
  const bool a = scene == "A";
  std::ostringstream text;
  text.precision(17);
  text << "grid: {width: " << size << ", height: " << size << ", cell_size: " << 1024.0 / size << "}\n"
       << "terrain:\n  - noise: {layer: sand, low: " << (a ? 0.5 : 3.0) << ", high: " << (a ? 2.0 : 5.0)
       << "}\n"
       << "wind: {speed: " << (a ? 5 : 3) << ", direction_deg: 0}\n";
  return parse_scenario_text(text.str(), scene, settings);
}

int default_steps(int size, bool gpu) {
  if (!gpu) return size <= 512 ? 100 : 20;
  return size <= 1024 ? 1000 : (size <= 2048 ? 600 : (size <= 4096 ? 200 : 40));
}

/// Bytes per second that a large copy moves (read and written).
double copy_bandwidth(Exec& exec) {
  const std::size_t bytes = std::min<std::size_t>(std::size_t{1} << 30, exec.memory_available() / 8);
  Buffer<char> from(exec, bytes), to(exec, bytes);
  from.set_zero();
  std::vector<double> times;
  for (int n = 0; n < 7; ++n) {
    exec.synchronise();
    const auto start = Clock::now();
    exec.copy(to.data(), from.data(), bytes);
    exec.synchronise();
    times.push_back(milliseconds(Clock::now() - start));
  }
  return 2.0 * static_cast<double>(bytes) / (median(times) * 1e-3);
}

Result bench(const Options& o) {
  Result r;
  r.size = static_cast<int>(o.number("size", 512, 16, 65536));
  r.scene = o.text("scene", "A");
  Settings settings = o.all("set");
  if (o.has("quality")) settings.push_back("avalanching.quality=" + o.text("quality", ""));
  const Scenario scenario = bench_scenario(r.scene, r.size, settings);
  r.quality = avalanche_qualities[static_cast<int>(scenario.avalanching.quality)];
  const int threads = static_cast<int>(o.number("threads", 0, 1, 4096));
  if (threads > 0) omp_set_num_threads(threads);
  Session session(scenario, raster_loader(), o.text("backend", "auto"), threads);
  Simulation& s = session.simulation();
  r.backend = s.exec().backend();
  r.device = s.exec().device();
  if (const auto* cpu = dynamic_cast<CpuExec*>(&s.exec())) r.threads = cpu->threads();
  r.cell_size = s.scenario().grid.cell_size;
  r.steps = static_cast<int>(o.number("steps", default_steps(r.size, r.threads == 0), 10, 1000000));

  // Blocks of a tenth of the steps, the median of which counts; the first is warm-up.
  constexpr int blocks = 10;
  std::vector<double> times;
  for (int block = 0; block < blocks; ++block) {
    const int count = std::max(1, r.steps / blocks);
    s.exec().synchronise();
    const auto start = Clock::now();
    for (int n = 0; n < count; ++n) s.step();
    s.exec().synchronise();
    if (block > 0) times.push_back(milliseconds(Clock::now() - start) / count);
  }
  r.ms = median(times);
  r.fastest_ms = *std::min_element(times.begin(), times.end());
  r.slowest_ms = *std::max_element(times.begin(), times.end());
  r.residual = s.residual();
  r.iterations = s.mean_avalanche_iterations();

  const int timed = std::max(3, r.steps / 20);
  s.set_timing(true);
  for (int n = 0; n < timed; ++n) s.step();
  r.processes = s.process_times();
  for (ProcessTime& t : r.processes) t.milliseconds /= timed;
  const MaterialBalance sand = s.balance()[static_cast<std::size_t>(Material::sand)];
  r.sand_lost = static_cast<double>(sand.residual()) / static_cast<double>(std::max(1LL, sand.initial));
  r.bandwidth = copy_bandwidth(s.exec());
  return r;
}

double share_of_bandwidth(const Result& r, const ProcessTime& t) {
  for (const ProcessBytes& p : fewest_bytes)
    if (std::string(p.process) == t.process)
      return p.bytes * r.size * r.size / (t.milliseconds * 1e-3) / r.bandwidth;
  return 0;
}

void print_text(const Result& r) {
  const double cells = static_cast<double>(r.size) * r.size;
  std::printf("scene %s, %d x %d cells of %g m, %s (%s), quality %s, %d steps\n", r.scene.c_str(), r.size,
              r.size, r.cell_size, r.backend.c_str(), r.device.c_str(), r.quality.c_str(), r.steps);
  std::printf(
      "  whole step    %9.4f ms (median of 9 blocks; %.4f ... %.4f)   %.4f us a cell, %.2f M cell-steps/s\n",
      r.ms, r.fastest_ms, r.slowest_ms, r.ms * 1e3 / cells, cells / r.ms * 1e-3);
  std::printf("  memory        %.1f GB/s copied; a step takes %.1f x the time of 100 bytes a cell\n",
              r.bandwidth * 1e-9, r.ms * 1e-3 / (100 * cells / r.bandwidth));
  for (const ProcessTime& t : r.processes)
    std::printf("  %-12s  %9.4f ms   %5.1f %% of bandwidth for its fewest bytes\n", t.process, t.milliseconds,
                100 * share_of_bandwidth(r, t));
  std::printf(
      "  residual      %.4f %% of cells over 1e-3, %.4f %% over 1e-2, mean excess %.5f, largest %.5f; %.1f "
      "fine sweeps a step\n",
      100 * r.residual.share_over_1e3, 100 * r.residual.share_over_1e2, r.residual.mean_excess,
      r.residual.largest_excess, r.iterations);
  std::printf("  sand lost     %g\n", r.sand_lost);
}

void print_json(const Result& r) {
  std::printf(
      "{\"scene\": \"%s\", \"size\": %d, \"cell_size_m\": %.17g, \"backend\": \"%s\", \"device\": \"%s\", "
      "\"threads\": %d, \"quality\": \"%s\", "
      "\"steps\": %d, \"ms_per_step\": %.6f, \"fastest_ms\": %.6f, \"slowest_ms\": %.6f, "
      "\"copy_bytes_per_s\": %.6g, \"processes\": {",
      r.scene.c_str(), r.size, r.cell_size, r.backend.c_str(), r.device.c_str(), r.threads, r.quality.c_str(),
      r.steps, r.ms, r.fastest_ms, r.slowest_ms, r.bandwidth);
  for (std::size_t n = 0; n < r.processes.size(); ++n)
    std::printf("%s\"%s\": {\"ms\": %.6f, \"share_of_bandwidth\": %.4f}", n ? ", " : "",
                r.processes[n].process, r.processes[n].milliseconds, share_of_bandwidth(r, r.processes[n]));
  std::printf(
      "}, \"residual\": {\"share_over_1e-3\": %.6g, \"share_over_1e-2\": %.6g, \"mean_excess\": %.6g, "
      "\"largest_excess\": %.6g}, "
      "\"fine_sweeps\": %.1f, \"sand_lost\": %g}\n",
      r.residual.share_over_1e3, r.residual.share_over_1e2, r.residual.mean_excess, r.residual.largest_excess,
      r.iterations, r.sand_lost);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Options o(argc, argv, {"size", "scene", "steps", "backend", "threads", "quality", "set"},
                    {"json", "help"});
    if (o.has("help")) return std::fputs(usage, stdout), 0;
    if (!o.positional().empty())
      throw ConfigError("'" + o.positional()[0] + "': unexpected (--help shows how)");
    const Result result = bench(o);
    o.has("json") ? print_json(result) : print_text(result);
    return 0;
  } catch (const ConfigError& e) {
    std::fprintf(stderr, "desert_bench: %s\n", e.what());
    return 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "desert_bench: %s\n", e.what());
    return 3;
  }
}
