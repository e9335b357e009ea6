/// Whether thin sand oscillates from cell to cell (support/oscillation.hpp) in scenarios, and with which
/// settings it does not.
#include <cstdio>
#include <filesystem>

#include "src/command_line/program.hpp"
#include "src/core/error.hpp"
#include "test/support/oscillation.hpp"
#include "test/support/running.hpp"

using namespace desert_sim;

namespace {

Options options() {
  Options o("grid_oscillation", "Tells whether thin sand oscillates from cell to cell in scenarios.");
  o.positional("SCENARIO", "a YAML file", 1, 1000)
      .option("steps", "N", "steps to run (default: each scenario's run.steps)")
      .option("set", "PATH=VALUE", "override a key of all scenarios; may be repeated")
      .footer(
          "Prints for each scenario the share of the cells with 1 cm to 1 m of sand that\n"
          "oscillate by more than 2 cm, and the root mean square of what oscillates, each\n"
          "for the worse of rows and columns.\n"
          "Exit status: 0; 1 if a share is over 3 % or a root mean square over 3 cm; 2 for\n"
          "invalid input; 3 for a failure at run time.");
  return o;
}

int run(const Options& given) {
  bool even = true;
  for (const std::string& path : given.positional()) {
    const Scenario scenario = load_scenario(path, given.values("set"));
    const auto steps = static_cast<int>(given.number("steps", scenario.run.steps, 0, 1'000'000'000));
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

int main(int argc, char** argv) { return run_main(options(), argc, argv, run); }
