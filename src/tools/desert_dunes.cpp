/// desert_dunes: follows the dunes of a run, and writes a table of them.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>

#include "src/command_line/program.hpp"
#include "src/core/constants.hpp"
#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/core/number_text.hpp"
#include "src/core/time_units.hpp"
#include "src/tools/drawing.hpp"
#include "src/tools/dune_tracker.hpp"
#include "src/tools/run_history.hpp"

using namespace desert_sim;

namespace {

Options options() {
  Options o("desert_dunes", "Follows the dunes of a run, and writes a table of them.");
  o.positional("RUN", "the --out folder of desert_run --every N, or its terrain.nc")
      .option("out", "FILE", "the table (CSV; default: the standard output)")
      .option("layer", "NAME", "sand (default): the depth of sand is the height; or elevation")
      .option("base", "M", "height that counts as 0 [m] (default 0)")
      .option("threshold", "M", "a dune is what is higher than this above the base [m] (default 0.25)")
      .option("least-height", "M", "lower dunes do not count [m] (default 0.5)")
      .option(
          "direction", "DEG",
          "along which lengths are measured, counter-clockwise from +x (default: that of the mean wind over "
          "the run)")
      .option("plot", "FILE", "draw a PNG of ways, heights and speeds (needs python3 with matplotlib)")
      .needs("out")
      .footer(
          "A line of the table is a dune at a time; doc/science/measuring.md explains it.\n"
          "Exit status: 0; 2 for invalid input; 3 for a failure at run time.");
  return o;
}

/// Direction of the mean wind at the surface over all times [deg].
double mean_wind(const RunHistory& history) {
  double sum[2] = {0, 0};
  const char* const layers[2] = {"wind_x", "wind_y"};
  for (int axis = 0; axis < 2; ++axis)
    for (std::size_t n = 0; n < history.times().size(); ++n)
      for (float w : history.read(layers[axis], n).values)
        if (std::isfinite(w)) sum[axis] += static_cast<double>(w);
  return std::atan2(sum[1], sum[0]) * 180 / pi;
}

DuneField heights_of(LayerField layer, double base) {
  for (float& value : layer.values) value = static_cast<float>(static_cast<double>(value) - base);
  return {layer.width,    layer.height,   layer.cell_size,        layer.origin_x,
          layer.origin_y, layer.periodic, std::move(layer.values)};
}

/// First and last of a dune, for the summary.
struct Course {
  int times = 0;
  double height = 0, speed = 0;
  int speeds = 0;
};

/// Those of which a speed is known; the table has all.
void print_courses(const std::map<int, Course>& courses) {
  const auto known = std::count_if(courses.begin(), courses.end(),
                                   [](const auto& course) { return course.second.speeds > 0; });
  std::fprintf(stderr, "%d dunes, %d of them at two times or more:\n", static_cast<int>(courses.size()),
               static_cast<int>(known));
  std::fprintf(stderr, "  id  times  mean height [m]  mean speed [m/s]  [m/a]\n");
  for (const auto& [id, course] : courses) {
    if (course.speeds == 0) continue;
    const double speed = course.speed / course.speeds;
    std::fprintf(stderr, "%4d  %5d  %15.3f  %16.4g  %.4g\n", id, course.times, course.height / course.times,
                 speed, speed * seconds_per_year);
  }
}

int run_program(const Options& o) {
  const std::string out = o.text("out", ""), layer = o.text("layer", "sand");
  const double base = o.real("base", 0, -1e6, 1e6);
  const DuneLimits limits{o.real("threshold", 0.25, 1e-6, 1e6), o.real("least-height", 0.5, 0, 1e6)};
  const double given = o.real("direction", 0, -360, 360);
  const auto history = open_history(o.positional()[0]);
  if (!out.empty()) require_writable_file(out);
  DuneTracker tracker(limits, o.has("direction") ? given : mean_wind(*history));
  std::string table = dune_table_head();
  std::map<int, Course> courses;
  for (std::size_t n = 0; n < history->times().size(); ++n)
    for (const DuneRecord& r : tracker.add(history->times()[n], heights_of(history->read(layer, n), base))) {
      table += dune_table_line(r);
      Course& course = courses[r.id];
      ++course.times;
      course.height += r.dune.height;
      if (r.velocity) course.speed += std::hypot(r.velocity->x, r.velocity->y), ++course.speeds;
    }
  if (out.empty()) {
    std::cout << table;
    return 0;
  }
  write_file(out, table);
  print_courses(courses);
  if (o.has("plot")) run_plot_script("--plot", "plot_dunes.py", o.text("plot", ""), {out});
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return run_main(options(), argc, argv, run_program); }
