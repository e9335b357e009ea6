#pragma once
/// What others see of a simulation: snapshots of layers, plants, and what subscribers lack of the elevation
/// and of the costs. Copies to the host go on beside the next steps.

#include <memory>
#include <vector>

#include "src/simulation/pipeline/pipeline.hpp"
#include "src/simulation/state.hpp"
#include "src/simulation/views/cost_changes.hpp"
#include "src/simulation/views/elevation_changes.hpp"
#include "src/simulation/views/snapshot.hpp"

namespace desert_sim {

class Views {
 public:
  Views(SimulationState& state, Pipeline& pipeline) : state_(state), pipeline_(pipeline) {}

  /// Starts a copy of layers to the host; the next step may be started at once, and does not show in it.
  /// Elevation and wind are brought up to date first, and layers that exist on request computed, if they are
  /// asked for; what was never asked for takes no memory. Of a band of rows only those are copied and
  /// computed: the snapshot's height and origin are the band's, less what lies off an open terrain (at least
  /// one row is left).
  PendingSnapshot begin_snapshot(const std::vector<Layer>& layers, const RowBand& band = {});
  /// Starts a copy of all plants to the host, in the order of their look-up.
  PendingPlants begin_plants();
  /// Whether a snapshot of the layer has more to show than 0 everywhere.
  bool shows(Layer layer) const;
  /// Gives back the memory of layers that exist on request, until one is asked for again.
  void release_requested_layers();

  /// Notes the present elevation as what subscribers hold, or that they hold none.
  void hold_elevation();
  void forget_elevation() { held_elevation_ = {}; }
  bool holds_elevation() const { return static_cast<bool>(held_elevation_); }
  /// Starts a copy of the cells whose elevation differs by more than `threshold` [m] from what is held, which
  /// then is held: whoever drops the answer lacks them from then on. `tile`: cells on a side of a tile.
  /// Throws StateError if nothing is held.
  Pending<ElevationChanges> begin_elevation_changes(double threshold, int tile);

  /// Starts a copy of what subscribers lack of the costs of the terrain, for the rover of the scenario's
  /// section `traversability`; it is held then: whoever drops the answer lacks it from then on.
  PendingCosts begin_costs(const CostQuery& query);
  void forget_costs() { costs_ = {}; }

  /// Memory through which copies go to the host.
  Staging& staging() { return staging_; }
  std::vector<MemoryPart> memory() const;

 private:
  /// A snapshot whose layers are there and empty.
  std::shared_ptr<Snapshot> make_empty_snapshot(const std::vector<Layer>& layers, const RowBand& rows) const;
  /// Computes those of `layers` that exist on request, in a band that lies on the terrain.
  void compute_requested_layers(const std::vector<Layer>& layers, const RowBand& rows);
  /// Starts the copy of some rows of the snapshot's layers, which are appended to what it has.
  void send_rows(const std::shared_ptr<Snapshot>& snapshot, const RowBand& rows,
                 const std::shared_ptr<Readback>& readback);

  SimulationState& state_;
  Pipeline& pipeline_;
  Staging staging_{state_.exec()};
  Buffer<float> held_elevation_;  ///< [m]; empty while subscribers hold none
  HeldCosts costs_;               ///< likewise
};

}  // namespace desert_sim
