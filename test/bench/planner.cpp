/// Times of planners by the size of the grid: a whole field, and its repair after a share of the cells has
/// changed. doc/robotics/planner.md has results.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "src/command_line/program.hpp"
#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/planner/field_planner.hpp"
#include "src/planner/grid_path.hpp"
#include "src/simulation/session.hpp"
#include "src/tools/rasters.hpp"
#if DESERT_WITH_NAVFN
#include <navfn/navfn.h>
#endif

using namespace desert_sim;

namespace {

Options options() {
  Options o("planner_bench", "Times the field planner's repairs of its cost field beside computing it anew.");
  o.positional("SCENARIO.yaml", "whose terrain is mirrored until it fills the grid")
      .option("size", "N", "cells along each side of the grid; may be repeated (default 512, 1024, 2048)")
      .option("rounds", "N", "changes of the terrain (default 8)")
      .option("percent", "N",
              "percent of the cells that have changed their cost in each round, at least (default 1)")
      .option("threads", "N", "of the simulation (default 1); planners have one")
      .footer(
          "In each round the scenario makes steps until as many cells have changed. Five\n"
          "rovers have paths across the grid. A row has median and worst times [ms] on the\n"
          "processor: of the whole field (compute), of its repair as far as the path of one\n"
          "rover needs it (path), and of the rest of it (rest); where navfn is built, of its\n"
          "whole field and of its A* (both anew in each round). Each repair is compared with\n"
          "a field that is computed anew.\n"
          "Exit status: 0; 1 if any cell differs; 2 for invalid input; 3 for a failure at\nrun time.");
  return o;
}

/// Time that this thread has had a processor [ms]: it does not count what other programs take.
double processor_time() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}
double time_of(const std::function<void()>& work) {
  const double begin = processor_time();
  work();
  return processor_time() - begin;
}

struct Times {
  std::vector<double> values;
  void add(double ms) { values.push_back(ms); }
  double median() const {
    std::vector<double> v = values;
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
  }
  double worst() const { return *std::max_element(values.begin(), values.end()); }
  std::string text() const {
    char line[40];
    std::snprintf(line, sizeof line, "%7.2f %7.2f", values.empty() ? 0 : median(),
                  values.empty() ? 0 : worst());
    return line;
  }
};

/// Traversability of a terrain that lives.
class Ground {
 public:
  Ground(const std::string& scenario, int threads)
      : session_(load_scenario(scenario), raster_loader(), "cpu", threads) {}
  /// Makes steps until this share of the cells has another cost; the share.
  double change(double share) {
    const CostGrid buckets({1, 1, 1, 0, 0}, {});
    const std::vector<float> before = values_;
    double changed = 0;
    for (int n = 0; n < 10000 && (changed < share || before.empty()); n += 5) {
      for (int k = 0; k < (before.empty() ? 0 : 5); ++k) session_.step();
      const auto snapshot = session_.simulation().views().snapshot({Layer::traversability});
      width_ = snapshot->width, height_ = snapshot->height;
      values_ = *snapshot->find(Layer::traversability);
      if (before.empty()) return 0;
      changed = 0;
      for (std::size_t i = 0; i < values_.size(); ++i)
        changed += buckets.cost_of(values_[i]) != buckets.cost_of(before[i]);
      changed /= static_cast<double>(values_.size());
    }
    return changed;
  }
  std::vector<float> mirrored(int size) const {
    const auto fold = [](int n, int count) {
      return n % (2 * count) < count ? n % count : count - 1 - n % count;
    };
    std::vector<float> all;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        all.push_back(values_[static_cast<std::size_t>(fold(y, height_) * width_ + fold(x, width_))]);
    return all;
  }

 private:
  Session session_;
  std::vector<float> values_;
  int width_ = 0, height_ = 0;
};

struct Rover {
  CellIndex start, goal;
};

/// Across the grid in several directions, where the ground is passable and a path leads.
std::vector<Rover> rovers_on(const CostGrid& grid) {
  const GridFrame& f = grid.frame();
  const double w = f.width * f.cell_size, h = f.height * f.cell_size;
  std::vector<Rover> rovers;
  const double places[][4] = {{0.05, 0.5, 0.95, 0.5},
                              {0.95, 0.3, 0.05, 0.6},
                              {0.5, 0.05, 0.4, 0.95},
                              {0.08, 0.08, 0.93, 0.91},
                              {0.1, 0.9, 0.5, 0.5}};
  for (const auto& p : places) {
    const auto start = grid.nearest_passable({p[0] * w, p[1] * h}, 30),
               goal = grid.nearest_passable({p[2] * w, p[3] * h}, 30);
    if (start && goal) rovers.push_back({*start, *goal});
  }
  if (rovers.empty()) throw ConfigError("no ground of the scenario is passable where rovers would start");
  return rovers;
}

#if DESERT_WITH_NAVFN
/// navfn on the same costs: 0 … 252, 254 lethal.
class Navfn {
 public:
  explicit Navfn(const CostGrid& grid) : grid_(grid), navfn_(grid.frame().width, grid.frame().height) {}
  void run(const Rover& rover, Times& dijkstra, Times& astar) {
    const GridFrame& f = grid_.frame();
    std::vector<unsigned char> map;
    for (int y = 0; y < f.height; ++y)
      for (int x = 0; x < f.width; ++x) {
        const std::uint8_t c = grid_.cost(grid_.cell(x, y));
        map.push_back(c == CostGrid::lethal ? 254 : static_cast<unsigned char>((c - CostGrid::cheapest) * 7));
      }
    int start[2] = {grid_.x_of(rover.start), grid_.y_of(rover.start)},
        goal[2] = {grid_.x_of(rover.goal), grid_.y_of(rover.goal)};
    for (Times* times : {&dijkstra, &astar}) {
      navfn_.setCostmap(map.data(), true, true);
      navfn_.setGoal(goal);
      navfn_.setStart(start);
      times->add(
          time_of([&] { times == &dijkstra ? navfn_.calcNavFnDijkstra(false) : navfn_.calcNavFnAstar(); }));
    }
  }

 private:
  const CostGrid& grid_;
  navfn::NavFn navfn_;
};
#endif

/// One size of grid, and its fields: one a rover.
class Row {
 public:
  Row(int size, const Ground& ground) : size_(size), grid_({size, size, 0.5, 0, 0}, {}), reference_(grid_) {
    update(ground);
    rovers_ = rovers_on(grid_);
    for (const Rover& r : rovers_) {
      fields_.emplace_back(grid_);
      whole_.add(time_of([&] { fields_.back().compute(r.goal); }));
    }
  }
  void round(const Ground& ground) {
    grids_.add(time_of([&] { update(ground); }));
    for (std::size_t n = 0; n < rovers_.size(); ++n) {
      FieldPlanner& field = fields_[n];
      path_.add(time_of([&] {
        field.note(changed_);
        field.repair(rovers_[n].start);
      }));
      wrong_ += field.differences(reference_);
      rest_.add(time_of([&] { field.repair({}); }));
      whole_.add(time_of([&] { reference_.compute(rovers_[n].goal); }));
      wrong_ += field.differences(reference_);
      reached_ += reference_.value(rovers_[n].start) < FieldPlanner::unreachable;
    }
#if DESERT_WITH_NAVFN
    Navfn navfn(grid_);
    for (const Rover& r : rovers_) navfn.run(r, navfn_, astar_);
#endif
    ++rounds_;
  }
  std::size_t wrong() const { return wrong_; }
  void print() const {
    std::printf("%5d  %s  %s  %s  %s  %s  %5zu of %zu  %zu\n", size_, whole_.text().c_str(),
                path_.text().c_str(), rest_.text().c_str(), navfn_.text().c_str(), astar_.text().c_str(),
                reached_, rounds_ * rovers_.size(), wrong_);
  }

 private:
  void update(const Ground& ground) {
    changed_.clear();
    grid_.update({0, 0, size_, size_}, ground.mirrored(size_).data(), changed_);
  }

  int size_;
  CostGrid grid_;
  FieldPlanner reference_;
  std::vector<Rover> rovers_;
  std::vector<FieldPlanner> fields_;
  std::vector<CellIndex> changed_;
  Times whole_, path_, rest_, navfn_, astar_, grids_;
  std::size_t wrong_ = 0, reached_ = 0, rounds_ = 0;
};

int run(const Options& o) {
  const auto rounds = o.number("rounds", 8, 1, 1000);
  Ground ground(o.positional().front(), static_cast<int>(o.number("threads", 1, 0, 4096)));
  ground.change(0);
  std::vector<std::unique_ptr<Row>> rows;
  for (int side : o.numbers("size", {512, 1024, 2048}, 64, 8192))
    rows.push_back(std::make_unique<Row>(side, ground));
  double changed = 0;
  for (long long n = 0; n < rounds; ++n) {
    changed += ground.change(1e-2 * static_cast<double>(o.number("percent", 1, 1, 100))) /
               static_cast<double>(rounds);
    for (const auto& row : rows) row->round(ground);
  }
  std::printf(
      "%.2f %% of the cells change in a round; times in ms, median and worst\n"
      " size            whole            path            rest  navfn whole      navfn A*    a path  wrong\n",
      100 * changed);
  std::size_t wrong = 0;
  for (const auto& row : rows) {
    row->print();
    wrong += row->wrong();
  }
  return wrong == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) { return run_main(options(), argc, argv, run); }
