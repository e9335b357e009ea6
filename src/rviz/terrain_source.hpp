#pragma once
/// The terrain of a node for a display: receives on the client's own thread, and hands over immutable maps with the
/// cells that changed since the last call, however many messages came in between. Nothing waits for the other side.

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "src/client/terrain_client.hpp"
#include "src/render/cells.hpp"

namespace desert_sim {

/// What changed between two calls of PendingChanges::take().
struct TerrainChange {
  std::shared_ptr<const ElevationMap> map;     ///< null: nothing has changed
  bool replaced = false;                       ///< the frame, size or place is another one; all cells are new
  std::vector<render::CellRectangle> changed;  ///< tiles of up to 64 × 64 cells in which a cell changed
  int messages = 0;                            ///< how many messages are in this change
};

/// Collects changes until somebody takes them. Its memory is bounded by the size of one map, whatever the rate of
/// messages. add() is for one thread, take() for another one.
class PendingChanges {
 public:
  static constexpr int tile_side = 64;  ///< [cells]

  /// The maps are compared, so that only tiles with different values count as changed.
  void add(const MapChange& change);
  TerrainChange take();

 private:
  std::shared_ptr<const ElevationMap> last_;  ///< the last map of add()
  std::mutex mutex_;                          ///< protects the members below; held only briefly
  TerrainChange pending_;
  std::vector<char> tiles_;  ///< which tiles of pending_.map changed, row-major
};

class TerrainSource {
 public:
  /// `elevation_topic`: the topic of keyframes, such as /desert_sim/elevation; others of its node are beside it. Throws
  /// ConfigError for an invalid name.
  explicit TerrainSource(const std::string& elevation_topic);

  TerrainChange take() { return changes_.take(); }
  bool connected() const { return client_->connected(); }
  bool up_to_date() const { return client_->up_to_date(); }
  TerrainClient::Statistics statistics() const { return client_->statistics(); }

 private:
  PendingChanges changes_;
  std::unique_ptr<TerrainClient> client_;  ///< the last member: its thread uses the others
};

/// The namespace of the node of a topic, "/desert_sim" for "/desert_sim/elevation".
std::string node_of_topic(const std::string& elevation_topic);

}  // namespace desert_sim
