/// Speed of the models that move sand in slabs or grains, each in a shipped scenario, beside a sequential
/// program of the same model where there is one: doc/notebook/slab_models.md has results.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/command_line/program.hpp"
#include "src/core/error.hpp"
#include "test/support/running.hpp"
#include "test/support/sequential_slabs.hpp"

using namespace desert_sim;

namespace {

Options options() {
  Options o(
      "model_speed",
      "Times the models that move sand in slabs or grains, beside a sequential program of the same model "
      "where there is one.");
  o.positional("MODEL", "the rows (default: all)", 0, 100)
      .option("size", "N", "cells along each side (default 512)")
      .option("steps", "N", "steps of a round, in each of which every cell is polled once (default 10)")
      .option("rounds", "N",
              "timed rounds, of which the median counts (default 9), after one that does not count")
      .option("backend", "B", "auto (default), cpu or cuda")
      .option("threads", "N", "threads of the CPU backend")
      .flag("alone", "without the sequential programs")
      .footer(
          "Prints polls a second and nanoseconds a poll of a whole step, and where there is\n"
          "a sequential program its time on one thread, and how many times as long that is.\n"
          "Both take turns, so that what else the machine does slows both; the median of\n"
          "the ratios counts. A poll of wang is a packet of grains, one of desertscape_2019\n"
          "an event in the open.\n"
          "Exit status: 0; 2 for invalid input; 3 for a failure at run time.");
  return o;
}

/// Of sand on each cell at the beginning, in the scenarios of models with a sequential program.
constexpr int slabs = 3;

struct Model {
  const char *name, *scenario;
  Settings settings;  ///< with which a step is as long as it takes to poll each cell once
  test::SequentialSlabs (*sequential)(int cells, int slabs, unsigned seed);
};

const Model models[] = {
    {"werner", "werner_barchan", {}, test::sequential_werner},
    {"momiji", "momiji_barchan", {}, test::sequential_momiji},
    {"bishop", "bishop_barchan", {}, nullptr},
    {"nield_baas", "nield_nebkha", {}, nullptr},
    {"snow", "snow_barchan", {"run.time_step=10 min"}, nullptr},
    {"wang", "ripples", {}, nullptr},
    {"desertscape_2019",
     "barchan",
     {"sand.model=desertscape_2019", "saltation.lift=0.1", "desertscape_2019.slab=0.1"},
     nullptr},
};

struct Timing {
  int size, steps, rounds, threads;
  std::string backend;
  bool alone;
  double polls() const { return static_cast<double>(size) * size * steps; }  ///< of a round
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

template <class Work>
double seconds(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void time_model(const Model& model, const Timing& timing) {
  Settings settings = model.settings;
  for (const char* side : {"grid.width=", "grid.height="})
    settings.push_back(side + std::to_string(timing.size));
  Session session(shipped(model.scenario, settings), no_raster_loader, timing.backend, timing.threads);
  Exec& exec = session.simulation().exec();
  std::optional<test::SequentialSlabs> sequential;
  if (model.sequential != nullptr && !timing.alone) sequential = model.sequential(timing.size, slabs, 1);

  std::vector<double> ours, theirs, ratios;  // nanoseconds a poll
  for (int round = 0; round <= timing.rounds; ++round) {
    const double time = seconds([&] {
      for (int n = 0; n < timing.steps; ++n) session.step();
      exec.synchronise();
    });
    const double time_of_other = sequential ? seconds([&] { sequential->run(timing.steps); }) : 0;
    if (round == 0) continue;
    ours.push_back(1e9 * time / timing.polls());
    theirs.push_back(1e9 * time_of_other / timing.polls());
    ratios.push_back(time_of_other / time);
  }
  std::printf("%-16s %8.1f %8.2f", model.name, 1e3 / median(ours), median(ours));
  if (sequential) std::printf(" %11.1f %8.2f", median(theirs), median(ratios));
  std::printf("\n");
  std::fflush(stdout);
}

/// The rows with these names, or all.
std::vector<const Model*> rows_named(const std::vector<std::string>& names) {
  std::vector<const Model*> rows;
  for (const Model& model : models)
    if (names.empty() || std::count(names.begin(), names.end(), model.name) > 0) rows.push_back(&model);
  for (const std::string& name : names)
    if (std::none_of(rows.begin(), rows.end(), [&](const Model* row) { return row->name == name; }))
      throw ConfigError("'" + name + "': there is no row of this model");
  return rows;
}

int run(const Options& o) {
  const auto number = [&](const char* name, int by_default, int least, int most) {
    return static_cast<int>(o.number(name, by_default, least, most));
  };
  const Timing timing{number("size", 512, 16, 65536), number("steps", 10, 1, 100000),
                      number("rounds", 9, 1, 1000),   number("threads", 0, 1, 4096),
                      o.text("backend", "auto"),      o.has("alone")};
  const std::vector<const Model*> rows = rows_named(o.positional());
  const std::unique_ptr<Exec> exec = make_exec(timing.backend, timing.threads);
  std::printf("%d x %d cells, %s\n", timing.size, timing.size, exec->device_name().c_str());
  std::printf("%-16s %8s %8s %11s %8s\n", "model", "Mpolls/s", "ns/poll", "sequential", "times");
  for (const Model* row : rows) time_model(*row, timing);
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return run_main(options(), argc, argv, run); }
