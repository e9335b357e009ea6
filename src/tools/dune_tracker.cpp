#include "src/tools/dune_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "src/core/constants.hpp"
#include "src/core/error.hpp"
#include "src/core/number_text.hpp"
#include "src/core/time_units.hpp"
#include "src/metrics/field.hpp"

namespace desert_sim {

namespace {

/// A cell of a dune; its coordinates go on over periodic borders.
struct Cell {
  int x, y, index;
};

/// Index of a cell, wrapped; −1 beyond an open border.
int index_of(const DuneField& f, int x, int y) {
  if (f.periodic) return wrapped(y, f.height) * f.width + wrapped(x, f.width);
  return x >= 0 && x < f.width && y >= 0 && y < f.height ? y * f.width + x : -1;
}

double height_at(const DuneField& f, int index) {
  return static_cast<double>(f.heights[static_cast<std::size_t>(index)]);
}

/// The connected cells above the threshold around (x, y), which are marked in `seen`.
std::vector<Cell> collect_cells(const DuneField& f, double threshold, int x, int y, std::vector<bool>& seen) {
  std::vector<Cell> cells{{x, y, index_of(f, x, y)}};
  seen[static_cast<std::size_t>(cells[0].index)] = true;
  for (std::size_t n = 0; n < cells.size(); ++n)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell at = cells[n];
        const int index = index_of(f, at.x + dx, at.y + dy);
        if (index < 0 || seen[static_cast<std::size_t>(index)] || !(height_at(f, index) > threshold))
          continue;
        seen[static_cast<std::size_t>(index)] = true;
        cells.push_back({at.x + dx, at.y + dy, index});
      }
  return cells;
}

/// The middle of a cell whose coordinates may have gone on over borders, brought back onto the terrain.
Position place(const DuneField& f, double x, double y) {
  double east = (x + 0.5) * f.cell_size, north = (y + 0.5) * f.cell_size;
  if (f.periodic) {
    const double width = f.width * f.cell_size, height = f.height * f.cell_size;
    east -= std::floor(east / width) * width;
    north -= std::floor(north / height) * height;
  }
  return {f.origin_x + east, f.origin_y + north};
}

Dune measure(const DuneField& f, const std::vector<Cell>& cells, double direction) {
  Dune dune;
  const double ex = std::cos(direction * pi / 180), ey = std::sin(direction * pi / 180);
  double sum = 0, sum_x = 0, sum_y = 0, along[2] = {1e300, -1e300}, across[2] = {1e300, -1e300};
  const Cell* top = cells.data();
  for (const Cell& c : cells) {
    const double h = height_at(f, c.index);
    sum += h;
    sum_x += h * c.x;
    sum_y += h * c.y;
    if (h > height_at(f, top->index)) top = &c;
    const double a = c.x * ex + c.y * ey, b = c.y * ex - c.x * ey;
    along[0] = std::min(along[0], a), along[1] = std::max(along[1], a);
    across[0] = std::min(across[0], b), across[1] = std::max(across[1], b);
    dune.at_edge |= !f.periodic && (c.x == 0 || c.y == 0 || c.x == f.width - 1 || c.y == f.height - 1);
    dune.cells.push_back(c.index);
  }
  const auto beside = [&](int dx, int dy) {
    const int index = index_of(f, top->x + dx, top->y + dy);
    return height_at(f, index < 0 ? top->index : index);
  };
  dune.height = beside(0, 0);
  dune.crest = place(f, top->x + parabola_top(beside(-1, 0), dune.height, beside(1, 0)),
                     top->y + parabola_top(beside(0, -1), dune.height, beside(0, 1)));
  dune.centre = place(f, sum_x / sum, sum_y / sum);
  dune.volume = sum * f.cell_size * f.cell_size;
  dune.length = (along[1] - along[0] + 1) * f.cell_size;
  dune.width = (across[1] - across[0] + 1) * f.cell_size;
  return dune;
}

/// From a to b [m], the short way over periodic borders.
Position way(const DuneField& f, Position a, Position b) {
  Position d{b.x - a.x, b.y - a.y};
  if (f.periodic) {
    const double width = f.width * f.cell_size, height = f.height * f.cell_size;
    d.x -= std::round(d.x / width) * width;
    d.y -= std::round(d.y / height) * height;
  }
  return d;
}

/// Which of the dunes, whose cells `owner` has by index, shares most cells with the former one; −1: none.
/// `moved`: how far the former dune is expected to have come [m].
int best_match(const DuneField& f, const Dune& former, Position moved, const std::vector<int>& owner) {
  const int dx = static_cast<int>(std::lround(moved.x / f.cell_size)),
            dy = static_cast<int>(std::lround(moved.y / f.cell_size));
  std::map<int, int> shared;
  for (int cell : former.cells) {
    const int index = index_of(f, cell % f.width + dx, cell / f.width + dy);
    if (index >= 0 && owner[static_cast<std::size_t>(index)] >= 0)
      ++shared[owner[static_cast<std::size_t>(index)]];
  }
  int best = -1, most = 0;
  for (const auto& [dune, cells] : shared)
    if (cells > most) best = dune, most = cells;
  return best;
}

/// Which of the former dunes covers most of `dune`'s cells; −1: none.
int best_origin(const DuneField& f, const Dune& dune, const std::vector<Position>& moved,
                const std::vector<int>& owners) {
  std::map<int, int> shared;
  for (std::size_t k = 0; k < moved.size(); ++k) {
    const int dx = static_cast<int>(std::lround(moved[k].x / f.cell_size)),
              dy = static_cast<int>(std::lround(moved[k].y / f.cell_size));
    for (int cell : dune.cells) {
      const int index = index_of(f, cell % f.width - dx, cell / f.width - dy);
      if (index >= 0 && owners[static_cast<std::size_t>(index)] == static_cast<int>(k))
        ++shared[static_cast<int>(k)];
    }
  }
  int best = -1, most = 0;
  for (const auto& [former, cells] : shared)
    if (cells > most) best = former, most = cells;
  return best;
}

/// For each cell, whose it is; −1: nobody's.
std::vector<int> owners_of(const DuneField& f, const std::vector<DuneRecord>& dunes) {
  std::vector<int> owner(static_cast<std::size_t>(f.width) * static_cast<std::size_t>(f.height), -1);
  for (std::size_t n = 0; n < dunes.size(); ++n)
    for (int cell : dunes[n].dune.cells) owner[static_cast<std::size_t>(cell)] = static_cast<int>(n);
  return owner;
}

}  // namespace

std::vector<Dune> find_dunes(const DuneField& f, const DuneLimits& limits, double direction) {
  std::vector<bool> seen(f.heights.size(), false);
  std::vector<Dune> dunes;
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x) {
      const int index = y * f.width + x;
      if (seen[static_cast<std::size_t>(index)] || !(height_at(f, index) > limits.threshold)) continue;
      Dune dune = measure(f, collect_cells(f, limits.threshold, x, y, seen), direction);
      if (dune.height >= limits.least_height) dunes.push_back(std::move(dune));
    }
  std::stable_sort(dunes.begin(), dunes.end(),
                   [](const Dune& a, const Dune& b) { return a.volume > b.volume; });
  return dunes;
}

void DuneTracker::require_next(double time, const DuneField& f) const {
  if (grid_.width == 0) return;  // the first
  if (f.width != grid_.width || f.height != grid_.height || f.cell_size != grid_.cell_size)
    throw ConfigError("the grid at " + number_text(time, 9) + " s is not that of the times before");
  if (!(time > time_))
    throw ConfigError("the time " + number_text(time, 9) + " s does not follow " + number_text(time_, 9) +
                      " s");
}

/// For each of the next dunes, those of the present ones that claim to be it, the largest first.
std::vector<std::vector<std::size_t>> DuneTracker::claims(const DuneField& f,
                                                          const std::vector<Position>& moved,
                                                          const std::vector<DuneRecord>& next) const {
  const std::vector<int> owner = owners_of(f, next);
  std::vector<std::size_t> by_volume(present_.size());
  for (std::size_t k = 0; k < by_volume.size(); ++k) by_volume[k] = k;
  std::stable_sort(by_volume.begin(), by_volume.end(), [this](std::size_t a, std::size_t b) {
    return present_[a].dune.volume > present_[b].dune.volume;
  });
  std::vector<std::vector<std::size_t>> claims(next.size());
  for (std::size_t k : by_volume)
    if (const int match = best_match(f, present_[k].dune, moved[k], owner); match >= 0)
      claims[static_cast<std::size_t>(match)].push_back(k);
  return claims;
}

const std::vector<DuneRecord>& DuneTracker::add(double time, const DuneField& f) {
  require_next(time, f);
  const double elapsed = time - time_;
  time_ = time;
  grid_ = f;
  grid_.heights.clear();
  std::vector<DuneRecord> next;
  for (Dune& dune : find_dunes(f, limits_, direction_)) next.push_back({0, time, std::move(dune), {}, ""});
  std::vector<Position> moved;
  for (const DuneRecord& record : present_) {
    const Position v = record.velocity.value_or(Position());
    moved.push_back({v.x * elapsed, v.y * elapsed});
  }
  const std::vector<std::vector<std::size_t>> claimed = claims(f, moved, next);
  const std::vector<int> former = owners_of(f, present_);
  std::vector<bool> has_split(present_.size(), false);
  for (std::size_t n = 0; n < next.size(); ++n) {
    DuneRecord& record = next[n];
    if (!claimed[n].empty()) {
      record.id = present_[claimed[n][0]].id;
      for (std::size_t m = 1; m < claimed[n].size(); ++m)
        record.event += (m == 1 ? "joined " : " ") + std::to_string(present_[claimed[n][m]].id);
      continue;
    }
    record.id = next_id_++;
    if (const int origin = best_origin(f, record.dune, moved, former); origin >= 0) {
      record.event = "split " + std::to_string(present_[static_cast<std::size_t>(origin)].id);
      has_split[static_cast<std::size_t>(origin)] = true;
    }
  }
  for (std::size_t n = 0; n < next.size(); ++n)
    if (claimed[n].size() == 1 && !has_split[claimed[n][0]]) {
      const Position d = way(f, present_[claimed[n][0]].dune.centre, next[n].dune.centre);
      next[n].velocity = Position{d.x / elapsed, d.y / elapsed};
    }
  std::sort(next.begin(), next.end(), [](const DuneRecord& a, const DuneRecord& b) { return a.id < b.id; });
  present_ = std::move(next);
  return present_;
}

std::string dune_table_head() {
  return "id,time_s,crest_x_m,crest_y_m,x_m,y_m,height_m,width_m,length_m,volume_m3,speed_m_s,speed_m_a,"
         "direction_deg,at_edge,event\n";
}

std::string dune_table_line(const DuneRecord& r) {
  std::string line = std::to_string(r.id) + "," + number_text(r.time, 15);
  const Dune& d = r.dune;
  for (double value : {d.crest.x, d.crest.y, d.centre.x, d.centre.y}) line += "," + number_text(value, 12);
  for (double value : {d.height, d.width, d.length, d.volume}) line += "," + number_text(value, 7);
  if (r.velocity) {
    const double speed = std::hypot(r.velocity->x, r.velocity->y);
    line += "," + number_text(speed, 7) + "," + number_text(speed * seconds_per_year, 7) + "," +
            number_text(std::atan2(r.velocity->y, r.velocity->x) * 180 / pi, 6);
  } else {
    line += ",,,";
  }
  return line + (d.at_edge ? ",1," : ",0,") + r.event + "\n";
}

}  // namespace desert_sim
