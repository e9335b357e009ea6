/// Whether thin sand oscillates from cell to cell (support/oscillation.hpp) in scenarios, and with which
/// settings it does not.
#include <cstdio>
#include <filesystem>

#include "src/core/error.hpp"
#include "src/tools/options.hpp"
#include "src/tools/program.hpp"
#include "test/support/oscillation.hpp"
#include "test/support/running.hpp"

using namespace desert_sim;

namespace {

const char usage[] =
    "usage: grid_oscillation SCENARIO.yaml... [--steps N] [--set PATH=VALUE]...\n"
    "  --steps N         steps to run (default: each scenario's run.steps)\n"
    "  --set PATH=VALUE  override a key of all scenarios; may be repeated\n"
    "Prints for each scenario the share of the cells with 1 cm to 1 m of sand that oscillate by more than 2 "
    "cm,\n"
    "and the root mean square of what oscillates, each for the worse of rows and columns.\n"
    "Exit status: 0; 1 if a share is over 3 % or a root mean square over 3 cm; 2 for invalid input; 3 for a\n"
    "failure at run time.\n";

int run(int argc, char** argv) {
  const Options options(argc, argv, {"steps", "set"}, {"help"});
  if (options.has("help")) {
    std::fputs(usage, stdout);
    return 0;
  }
  if (options.positional().empty()) throw ConfigError("no scenario given; --help shows what is expected");
  bool even = true;
  for (const std::string& path : options.positional()) {
    const Scenario scenario = load_scenario(path, options.values("set"));
    const auto steps = static_cast<int>(options.number("steps", scenario.run.steps, 0, 1'000'000'000));
    constexpr int all_threads = 0;
    Running scene(scenario, all_threads);
    scene.run(steps);
    const Oscillation o = oscillation(scene.field(Layer::elevation), scene.field(Layer::sand));
    std::printf("%-24s %5.1f %% %6.3f m\n", std::filesystem::path(path).filename().c_str(), 100 * o.share,
                o.rms);
    std::fflush(stdout);
    even = even && o.share <= 0.03 && o.rms <= 0.03;
  }
  return even ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return run_main("grid_oscillation", argv, [&] { return run(argc, argv); });
}
