#pragma once
/// What others see of a simulation: snapshots of layers, plants, and what subscribers lack of layers
/// and of the costs. Copies to the host go on beside the next steps.

#include <map>
#include <memory>
#include <vector>

#include "src/simulation/pipeline/pipeline.hpp"
#include "src/simulation/state/state.hpp"
#include "src/simulation/views/cost_changes.hpp"
#include "src/simulation/views/layer_changes.hpp"
#include "src/simulation/views/snapshot.hpp"

namespace desert_sim {

class Views {
 public:
  Views(SimulationState& state, Pipeline& pipeline) : state_(state), pipeline_(pipeline) {}

  /// Starts a copy of layers to the host; the next step may be started at once, and does not show in it.
  /// Elevation and wind are brought up to date first, and layers that exist on request computed, if they are
  /// asked for; what was never asked for takes no memory. Of a band of rows only those are copied and
  /// computed: the snapshot's height and origin are the band's, less what lies off an open terrain (at least
  /// one row is left). `feet`: with the plants of the squares of the band, as far as MicroRelief needs them.
  PendingSnapshot begin_snapshot(const std::vector<Layer>& layers, const RowBand& band = {},
                                 bool feet = false);
  std::shared_ptr<const Snapshot> snapshot(const std::vector<Layer>& layers, const RowBand& band = {},
                                           bool feet = false) {
    return begin_snapshot(layers, band, feet).get();
  }
  /// Starts a copy of all plants to the host, in the order of their look-up.
  PendingPlants begin_plants();
  /// Starts a copy of the ways of at most `number` grains, spread over the terrain, that the wind lifts in
  /// the next step if nothing else happens before; none where another model moves the sand.
  PendingParticlePaths begin_particle_paths(int number);
  /// Whether a snapshot of the layer has more to show than 0 everywhere.
  bool shows(Layer layer) const;
  /// Gives back the memory of layers that exist on request, until one is asked for again.
  void release_requested_layers();

  /// Starts copies of the cells of layers that changed since what subscribers hold, which then is held:
  /// whoever drops the answer lacks them from then on. Layers are brought up to date and computed as for a
  /// snapshot. The answer has no entry for a layer of which nothing is held.
  PendingChanges begin_changes(const HeldQueries& queries);
  /// Gives back the memory of what subscribers hold of a layer.
  void forget(Layer layer) { held_.erase(layer); }
  bool holds(Layer layer) const { return held_.count(layer) > 0; }

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
  /// Brings layers that others see up to date: those that steps derive, and those of `layers` that exist on
  /// request, in a band that lies on the terrain.
  void update_layers(const std::vector<Layer>& layers, const RowBand& rows);
  void compute_requested_layers(const std::vector<Layer>& layers, const RowBand& rows);
  /// Starts the copy of some rows of the snapshot's layers, which are appended to what it has.
  void send_rows(const std::shared_ptr<Snapshot>& snapshot, const RowBand& rows,
                 const std::shared_ptr<Readback>& readback);
  /// Starts the copy of the snapshot's feet of plants.
  void send_feet(Snapshot& snapshot, const RowBand& rows, const std::shared_ptr<Readback>& readback);

  void hold(Layer layer);
  Pending<LayerChanges> send_changes(Layer layer, const HeldQuery& query);

  SimulationState& state_;
  Pipeline& pipeline_;
  Staging staging_{state_.exec()};
  std::map<Layer, Buffer<float>> held_;  ///< what subscribers hold of layers, in the layer's unit
  HeldCosts costs_;                      ///< empty while subscribers hold none
};

}  // namespace desert_sim
