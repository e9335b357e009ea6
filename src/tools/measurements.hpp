#pragma once
/// What desert_run measures while it runs: the sand that goes through cross-sections, and time series at
/// points.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "src/scenario/scenario.hpp"
#include "src/simulation/session.hpp"

namespace desert_sim {

struct Point {
  double x = 0, y = 0;  ///< in the terrain's frame [m]
};

/// A straight line across which sand goes: transport to the left of the way from `from` to `to` is positive.
class CrossSection {
 public:
  /// `text`: NAME=x1,y1,x2,y2. Throws ConfigError unless it is one that lies on the grid.
  CrossSection(const std::string& text, const GridParameters& grid);

  /// Adds what `flux`, a snapshot with the layers flux_x and flux_y, carries across in `duration` [s].
  void add(const Snapshot& flux, double duration);

  const std::string& name() const { return name_; }
  Point from() const { return from_; }
  Point to() const { return to_; }
  double length() const;                         ///< [m]
  double volume() const { return volume_; }      ///< [m³]
  double duration() const { return duration_; }  ///< [s]
  double per_metre_and_year() const;             ///< [m²/a]; 0 before the first step
  std::pair<int, int> rows() const;              ///< the first and the last that it crosses

 private:
  struct Piece {
    int x, y;       ///< cell
    double length;  ///< [m]
  };
  std::string name_;
  Point from_, to_;
  double origin_y_ = 0;  ///< of the terrain, which a snapshot of some rows does not say [m]
  std::vector<Piece> pieces_;
  double volume_ = 0, duration_ = 0;
};

/// Points whose layers are written as a table, a line each time and point.
class Probes {
 public:
  /// `points`: x,y each. Throws ConfigError unless all lie on the grid.
  Probes(const std::vector<std::string>& points, const GridParameters& grid);
  bool empty() const { return points_.empty(); }
  /// Appends the state; `snapshot` has the `layers`.
  void add(const Snapshot& snapshot, const std::vector<Layer>& layers);
  /// CSV: step, time [s], x, y [m], wind above [m/s, deg], and the layers in their units.
  const std::string& csv() const { return csv_; }
  std::pair<int, int> rows() const;  ///< the first and the last that has a point

 private:
  struct Cell {
    Point point;
    int x, y;
  };
  double origin_y_ = 0;
  std::vector<Cell> points_;
  std::string csv_;
};

/// All of a run.
class Measurements {
 public:
  Measurements() : probes_({}, {}) {}
  /// Throws ConfigError for a cross-section or probe that the scenario has no place for.
  Measurements(const std::vector<std::string>& cross_sections, const std::vector<std::string>& probes,
               std::uint64_t probe_every, const Scenario& scenario);
  /// Before a step: lets the flux be known, which a journal's reset or load may have ended.
  void keep_flux(Session& session) const;
  /// After a step of `duration` seconds.
  void add(Simulation& simulation, double duration);

  const std::vector<CrossSection>& cross_sections() const { return cross_sections_; }
  const Probes& probes() const { return probes_; }

 private:
  std::vector<CrossSection> cross_sections_;
  Probes probes_;
  std::uint64_t probe_every_ = 1;
};

}  // namespace desert_sim
