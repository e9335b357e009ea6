#pragma once
/// Levels for tests of the sweeps inside tiles: ordinary ones, and those that go to the ends of what floats
/// can count.

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/avalanching/avalanching.hpp"
#include "kernels/avalanching/tile.hpp"

namespace desert_sim::test {

struct TileField {
  std::string name;
  Grid grid;
  float quanta_per_cell = 1048576;
  std::vector<Quanta> ground, sand;
  std::vector<Quanta> soil;     ///< may be empty
  std::vector<float> obstacle;  ///< may be empty
  std::vector<float> repose;
  bool by_gradient = false;                         ///< quads in place of pairs, with ω ≤ ¾
  int first_shift = 0;                              ///< as in RelaxTile
  std::vector<Quanta> active_flags;                 ///< a tile each; may be empty: all are
  std::vector<Quanta> coarse_before, coarse_after;  ///< may be empty; of the next coarser grid

  Grid coarse() const {
    return {grid.width / 2, grid.height / 2, 2 * grid.cell_size, grid.periodic_x, grid.periodic_y};
  }
  /// The sand after one pass of `sweeps` sweeps in tiles that begin at −offset; by the reference, or as the
  /// backend does it best.
  std::vector<Quanta> relaxed(Exec& exec, int offset, int sweeps, bool by_law, float share = 0.5f,
                              float continue_threshold = 100, float edge_factor = 1) const;
  /// The sand after one pass of four sweeps, and what is filled after it, the bits of one layer after
  /// another: both coarse levels, or the heights with the highest of each block.
  std::vector<std::uint32_t> relaxed_and_restricted(Exec& exec, int offset) const;
  std::vector<std::uint32_t> relaxed_and_measured(Exec& exec, int offset) const;

 private:
  struct DeviceField;  ///< the level in a backend's memory
  avalanching::RelaxTile four_sweeps(DeviceField& device, int offset) const;
};

/// Dunes, cliffs of hundreds of metres, pits, films, columns as high as can be, walls, on whole and broken
/// tiles.
std::vector<TileField> tile_fields();

/// `columns` × `rows` copies of a field beside each other.
TileField tiled(const TileField& field, int columns, int rows);

/// Fields to which a coarser grid has changes to prolong: more sand, less, and as good as all.
std::vector<TileField> tile_fields_with_coarse_changes();

}  // namespace desert_sim::test
