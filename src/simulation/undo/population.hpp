#pragma once
/// The plants, as planting, clearing and undo change them between two steps.
///
/// Plants are sorted by their places; which of several at one place comes first decides what the next step
/// does. So that a plant which is put back stands where it stood in that order, each plant has a rank: those
/// that are there before the first change after a step are numbered in their order, and plants that are put
/// later get the next numbers. Ranks are never used again, and end with the step.
///
/// Plants also make vegetation, which a step computes from the plants as they are in the middle of it, so
/// that it cannot be computed anew afterwards. Therefore what each block of 8 × 8 cells had is kept for every
/// set of plants around it that there was since the last step. A set is known by a sum of numbers (marks):
/// one for each plant that was put or taken away.

#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "src/simulation/pipeline/pipeline.hpp"
#include "src/simulation/undo/cell_list.hpp"
#include "src/simulation/undo/stroke.hpp"

namespace desert_sim {

class Population {
 public:
  Population(SimulationState& state, Pipeline& pipeline) : state_(state), pipeline_(pipeline) {}

  /// What planting or clearing does: `removed` are numbers of plants in their present order, ascending.
  struct Edit {
    std::vector<std::uint32_t> removed;
    std::vector<PlantWords> added;
  };
  /// Makes the edit, and tells it. `remembers`: so that it can be undone.
  PlantChange paint(const Edit& edit, bool remembers);
  /// Takes away what `change` has put, and puts back what it has taken away, as far as there is room.
  /// `change` becomes what was changed now. Returns how many plants were missing.
  long long turn_back(PlantChange& change);

  /// How many plants of each species turn_back() would take away.
  std::vector<int> leaving(const PlantChange& change);

  /// Adds what paint() told to what a stroke has changed. Plants that the stroke itself had put, and has
  /// cleared now, have passed.
  void merge(PlantChange& stroke, PlantChange change) const;

  /// Whether the plant has its rank still, because no step was made since it was changed.
  bool is_current(const ChangedPlant& plant) const { return plant.rank >= first_rank_; }
  std::size_t bytes() const;
  /// What strokes would need that nobody can undo any more.
  void forget();

 private:
  /// What a block of cells had with one set of plants.
  struct Cover {
    std::uint64_t marks;
    std::vector<std::uint32_t> vegetation;
  };
  struct Block {
    std::uint64_t marks = 0;
    std::vector<Cover> covers;
  };
  struct Found {
    std::vector<std::uint32_t> places;  ///< ascending
    std::vector<ChangedPlant> plants;
  };

  void begin();
  Found find(const std::vector<ChangedPlant>& wanted) const;
  /// What an update of vegetation needs, made before the plants are changed.
  struct CoverUpdate {
    std::vector<int> blocks;           ///< that a changed plant reaches
    std::vector<std::uint64_t> marks;  ///< of all blocks: the sum over the changed plants that reach it
    CellList cells;                    ///< of `blocks`, one after the other
    Buffer<std::uint32_t> vegetation;
    Buffer<std::uint32_t> humus;  ///< which no time passes for: what is computed of it is not used
  };
  void replace(const std::vector<std::uint32_t>& removed, const std::vector<ChangedPlant>& added);
  CoverUpdate begin_cover(const std::vector<ChangedPlant>& changed) const;
  void update_cover(CoverUpdate& update, bool recall, bool remembers);
  Cover compute_cover(CoverUpdate& update);
  void keep_cover(Block& block, std::uint64_t marks, std::pair<std::size_t, std::size_t> cells,
                  const Cover& before, Cover& now, bool recall);
  std::vector<std::uint64_t> marks_of_blocks(const std::vector<ChangedPlant>& changed,
                                             std::vector<int>& blocks) const;
  std::vector<int> cells_of(int block) const;
  int block_columns() const;
  PlantWords plant_at(std::size_t place) const;
  std::size_t count() const { return words_.size() / plants::column_count; }

  SimulationState& state_;
  Pipeline& pipeline_;
  bool begun_ = false;
  std::uint64_t steps_ = 0;                       ///< to which the ranks belong
  std::uint64_t first_rank_ = 0, next_rank_ = 0;  ///< of those since the last step; of the next plant
  std::vector<std::uint32_t> words_;              ///< of all plants, column by column; only within a call
  std::vector<std::uint64_t> ranks_;              ///< of all plants, in their order
  std::unordered_map<int, Block> blocks_;
  std::size_t kept_covers_ = 0;  ///< cells in all covers together
};

}  // namespace desert_sim
