#pragma once
/// Finds dunes in heights and follows them from time to time.
///
/// A dune is a connected set of cells (eight neighbours, over periodic borders) that are higher than
/// `threshold` above the base. Its volume is all above the base in these cells, its place the centre of mass,
/// its crest the highest point of a parabola through the highest cell and its neighbours, its length the
/// extent along the wind or migration, and its width that across.
///
/// From time to time a dune's cells, moved as far as the dune moved in the step before, are laid over the
/// dunes of the next time. The dune with which they share most cells is the same dune. Where several dunes
/// claim the same one they have joined: the largest keeps its number, the others end. Where a dune covers
/// several it has split: the largest keeps the number, the others get new ones. Speeds are those of the
/// centre of mass since the time before; there is none at an event or at a dune's first time.

#include <optional>
#include <string>
#include <vector>

namespace desert_sim {

struct Position {
  double x = 0, y = 0;
};

/// Heights above the base [m], row-major from the south-west.
struct DuneField {
  int width = 0, height = 0;
  double cell_size = 1, origin_x = 0, origin_y = 0;
  bool periodic = false;
  std::vector<float> heights;
};

struct DuneLimits {
  double threshold = 0.25;    ///< [m] above the base
  double least_height = 0.5;  ///< lower dunes do not count [m]
};

struct Dune {
  Position crest, centre;
  double height = 0, length = 0, width = 0;  ///< [m]
  double volume = 0;                         ///< [m³]
  bool at_edge = false;                      ///< it reaches an open border, so that a part may be missing
  std::vector<int> cells;                    ///< indices, each once
};

/// `direction`: of wind or migration, counter-clockwise from +x [deg]. Largest volume first.
std::vector<Dune> find_dunes(const DuneField& field, const DuneLimits& limits, double direction);

/// A dune at one time.
struct DuneRecord {
  int id = 0;
  double time = 0;
  Dune dune;
  std::optional<Position> velocity;  ///< [m/s]
  std::string event;                 ///< "joined 3 4": these have ended in it; "split 2": it came off dune 2
};

class DuneTracker {
 public:
  DuneTracker(const DuneLimits& limits, double direction) : limits_(limits), direction_(direction) {}
  /// The dunes at a later time than the one before, by number. Throws ConfigError for an earlier one, or for
  /// another grid.
  const std::vector<DuneRecord>& add(double time, const DuneField& field);

 private:
  void require_next(double time, const DuneField& field) const;
  std::vector<std::vector<std::size_t>> claims(const DuneField& field, const std::vector<Position>& moved,
                                               const std::vector<DuneRecord>& next) const;

  DuneLimits limits_;
  double direction_;
  int next_id_ = 1;
  double time_ = 0;
  DuneField grid_;  ///< without heights
  std::vector<DuneRecord> present_;
};

/// The first line of the table, and a line for each record.
std::string dune_table_head();
std::string dune_table_line(const DuneRecord& record);

}  // namespace desert_sim
