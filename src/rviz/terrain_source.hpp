#pragma once
/// The terrain of a node for a display: receives on the client's own thread, and hands over immutable maps
/// with the cells that changed since the last call, however many messages came in between. Nothing waits for
/// the other side.

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "include/desert_sim/client/terrain_client.hpp"
#include "src/render/cells.hpp"

namespace desert_sim {

/// What changed in one layer between two calls of PendingChanges::take().
struct CollectedChange {
  std::shared_ptr<const LayerMap> map;
  bool replaced = false;                       ///< the frame, size or place is another one; all cells are new
  std::vector<render::CellRectangle> changed;  ///< where cells changed, at most one in each tile
  int messages = 0;                            ///< how many messages are in this change
};

/// Collects changes until somebody takes them. Its memory is bounded by the size of one map for each layer,
/// whatever the rate of messages. add() is for one thread, take() for another one.
class PendingChanges {
 public:
  static constexpr int tile_side = 64;  ///< [cells]

  /// The maps are compared, so that only cells with different values count as changed.
  void add(const MapChange& change);
  /// What changed since the last call, at most once for each layer, the elevation first.
  std::vector<CollectedChange> take();

 private:
  struct Pending {
    CollectedChange change;
    std::vector<render::CellRectangle> tiles;  ///< what changed in each tile, row-major
  };

  std::map<std::string, std::shared_ptr<const LayerMap>> last_;  ///< the last map of each layer in add()
  std::mutex mutex_;                                             ///< protects pending_; held only briefly
  std::map<std::string, Pending> pending_;                       ///< by layer
};

class TerrainSource {
 public:
  /// `elevation_topic`: the topic of keyframes, such as /desert_sim/elevation; others of its node are beside
  /// it. Throws ConfigError for an invalid name. Nothing is received before set_layers().
  explicit TerrainSource(const std::string& elevation_topic);

  /// Subscribes to these layers and to no others. Unknown names are ignored; see is_known().
  void set_layers(const std::vector<std::string>& layers);
  static bool is_known(const std::string& layer);

  std::vector<CollectedChange> take() { return changes_.take(); }
  const TerrainClient& client() const { return *client_; }
  /// The namespace of the topic: /desert_sim for /desert_sim/elevation.
  const std::string& node() const { return node_; }

 private:
  PendingChanges changes_;
  std::string node_;
  std::unique_ptr<TerrainClient> client_;  ///< the last member: its thread uses the others
};

}  // namespace desert_sim
