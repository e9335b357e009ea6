/// ~elevation and ~elevation_updates: the surface as a whole (keyframes), and the cells that changed since.

#include "src/ros/topics/elevation_topic.hpp"

#include <desert_sim/ElevationGrid.h>
#include <desert_sim/ElevationUpdate.h>
#include <std_msgs/Empty.h>

#include <algorithm>
#include <boost/make_shared.hpp>

#include "kernels/field/cell_box.hpp"
#include "src/client/layer_tile.hpp"
#include "src/ros/conversion/messages.hpp"
#include "src/ros/topics/topic_list.hpp"

namespace desert_sim {

namespace {

// ---- Messages.

/// The smallest box with all cells that changed.
CellBox changed_cells(const TileChange& change) {
  CellBox found;
  std::size_t row = 0;
  for (int y = 0; y < change.height; ++y, row += static_cast<std::size_t>(change.width)) {
    const auto changed = [&](int x) { return change.changed(row + static_cast<std::size_t>(x)); };
    int x0 = 0, x1 = change.width;
    while (x0 < x1 && !changed(x0)) ++x0;
    while (x0 < x1 && !changed(x1 - 1)) --x1;
    if (x0 < x1) found = found.united_with({x0, y, x1, y + 1});
  }
  return found;
}

/// The cells of `box`, row-major, from a tile that is `width` cells wide.
template <class Value>
std::vector<Value> cells_in(const std::vector<Value>& tile, int width, const CellBox& box) {
  std::vector<Value> cells;
  cells.reserve(static_cast<std::size_t>(box.width()) * static_cast<std::size_t>(box.height()));
  for (int y = box.y0; y < box.y1; ++y) {
    const auto row = tile.begin() + static_cast<std::ptrdiff_t>(y) * width;
    cells.insert(cells.end(), row + box.x0, row + box.x1);
  }
  return cells;
}

/// Removes the cells that did not change, without a branch for each cell. Returns the bit mask of those that
/// did, or an empty one if all did.
template <class Value>
std::vector<std::uint8_t> compact_changed(std::vector<Value>& cells, Value unchanged) {
  std::vector<std::uint8_t> mask(mask_bytes(cells.size()), 0);
  std::size_t kept = 0;
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    const unsigned changed = cells[cell] != unchanged ? 1 : 0;
    mask[cell / 8] = static_cast<std::uint8_t>(mask[cell / 8] | changed << (7 - cell % 8));
    cells[kept] = cells[cell];
    kept += changed;
  }
  if (kept == cells.size()) mask.clear();
  cells.resize(kept);
  return mask;
}

/// Packs two changes of four bits into each byte, the first into its high half.
std::vector<std::int8_t> packed_nibbles(std::vector<std::int8_t> changes) {
  const std::size_t bytes = change_bytes(changes.size(), 4);
  changes.resize(2 * bytes, 0);
  for (std::size_t n = 0; n < bytes; ++n)
    changes[n] = static_cast<std::int8_t>(changes[2 * n] * 16 | (changes[2 * n + 1] & 15));
  changes.resize(bytes);
  return changes;
}

}  // namespace

LayerTile tile_message(const TileChange& change) {
  const CellBox box = changed_cells(change);
  LayerTile tile;
  tile.x = static_cast<std::uint32_t>(change.x + box.x0);
  tile.y = static_cast<std::uint32_t>(change.y + box.y0);
  tile.width = static_cast<std::uint32_t>(box.width());
  tile.height = static_cast<std::uint32_t>(box.height());
  tile.bits = static_cast<std::uint8_t>(change.bits);
  tile.resolution = change.resolution;
  if (change.bits == 0) {
    tile.data = cells_in(change.elevations, change.width, box);
    tile.changed = compact_changed(tile.data, held_elevation::unchanged_elevation);
    return tile;
  }
  std::vector<std::int8_t> steps = cells_in(change.steps, change.width, box);
  tile.changed = compact_changed(steps, held_elevation::unchanged_step);
  tile.changes = change.bits == 4 ? packed_nibbles(std::move(steps)) : std::move(steps);
  return tile;
}

namespace {

ElevationGridPtr keyframe_message(const TerrainState& state, const std::string& frame,
                                  std::uint32_t keyframe) {
  const Snapshot& s = *state.snapshot;
  ElevationGridPtr message = boost::make_shared<ElevationGrid>();
  message->header = header_of(state.moment, frame);
  message->step = s.step;
  message->sim_time = s.time;
  message->keyframe = keyframe;
  message->width = static_cast<std::uint32_t>(s.width);
  message->height = static_cast<std::uint32_t>(s.height);
  message->cell_size = s.cell_size;
  message->origin = origin_of(s);
  message->elevation = s.layers.at(Layer::elevation);
  return message;
}

/// An update without tiles if the state has no changes: it starts a keyframe that nobody gets.
ElevationUpdatePtr update_message(const TerrainState& state, const std::string& frame, std::uint32_t keyframe,
                                  std::uint32_t sequence) {
  ElevationUpdatePtr message = boost::make_shared<ElevationUpdate>();
  message->header = header_of(state.moment, frame);
  message->step = state.snapshot->step;
  message->sim_time = state.snapshot->time;
  message->keyframe = keyframe;
  message->sequence = sequence;
  if (state.changes)
    for (const TileChange& change : state.changes->tiles) message->tiles.push_back(tile_message(change));
  return message;
}

// ---- Topics. The simulation keeps the elevation that subscribers hold, and forgets it when its terrain is
// replaced.

/// What the two topics share: the number of the present keyframe, and of the last update to it.
struct KeyframeNumbers {
  std::uint32_t keyframe = 0, update = 0;
  /// Whether the state that was asked for may start a keyframe that nobody gets.
  bool may_start_unpublished = false;

  void start_keyframe() {
    ++keyframe;
    update = 0;
  }
};

class ElevationTopic : public MessageTopic<ElevationGrid> {
 public:
  explicit ElevationTopic(const TopicContext& context) : MessageTopic(context, "elevation") {
    // roscpp has one connection for each topic and process: subscribers that share one are no new
    // subscribers, and have to ask for a keyframe.
    ros::NodeHandle node = context.node;
    keyframe_requests_ = node.subscribe<std_msgs::Empty>(
        "request_keyframe", 1, [this](const std_msgs::Empty::ConstPtr&) { request(); });
  }
  KeyframeNumbers& numbers() { return numbers_; }

  double rate() const override { return parameters().topics.keyframe_rate; }
  std::vector<Layer> layers() const override { return {Layer::elevation}; }
  void add_to(StateQuery& query) override {
    numbers_.may_start_unpublished = false;
    query.hold = updates()->has_subscribers() ? StateQuery::Hold::present : StateQuery::Hold::none;
  }
  bool publish(const TerrainState& state) override {
    numbers_.start_keyframe();
    publisher_.publish(keyframe_message(state, frame(), numbers_.keyframe));
    return true;
  }

 private:
  KeyframeNumbers numbers_;
  ros::Subscriber keyframe_requests_;  ///< ends first: its callback uses the rest
};

class ElevationUpdatesTopic : public MessageTopic<ElevationUpdate> {
 public:
  /// A new subscriber needs a keyframe first, which the updates are written over.
  ElevationUpdatesTopic(const TopicContext& context, std::uint32_t queue, ElevationTopic& keyframes)
      : MessageTopic(context, "elevation_updates", queue, keyframes), keyframes_(keyframes) {
    keyframes.set_updates(*this);
  }

  double rate() const override { return parameters().topics.update_rate; }
  void add_to(StateQuery& query) override {
    query.elevation_changes = true;
    query.elevation_threshold = parameters().topics.update_threshold;
    query.elevation_tile = parameters().topics.update_tile;
    bool& unpublished = keyframes_.numbers().may_start_unpublished;
    unpublished = !keyframes_.has_subscribers();
    query.hold = unpublished ? StateQuery::Hold::present_if_none : StateQuery::Hold::as_before;
  }
  /// Publishes nothing if the simulation holds no elevation of subscribers and some of them listen to
  /// keyframes: then a keyframe is due first. If nobody listens to keyframes, one is started that nobody
  /// gets.
  bool publish(const TerrainState& state) override {
    KeyframeNumbers& numbers = keyframes_.numbers();
    if (!state.changes) {
      if (!numbers.may_start_unpublished) return false;
      numbers.start_keyframe();
    }
    publisher_.publish(update_message(state, frame(), numbers.keyframe, ++numbers.update));
    return true;
  }

 private:
  ElevationTopic& keyframes_;
};

/// How many updates may wait for a slow subscriber; a subscriber that misses one asks for a keyframe. An
/// update is at most about as large as the whole surface.
std::uint32_t update_queue(const Snapshot& terrain) {
  constexpr std::size_t max_length = 100, min_length = 2, max_bytes = std::size_t{256} << 20;
  const std::size_t bytes =
      sizeof(float) * static_cast<std::size_t>(terrain.width) * static_cast<std::size_t>(terrain.height);
  return static_cast<std::uint32_t>(std::clamp(max_bytes / bytes, min_length, max_length));
}

}  // namespace

void add_elevation_topics(const TopicContext& context, TopicList& topics) {
  const std::uint32_t queue = update_queue(*context.simulation.terrain({}).get().snapshot);
  auto keyframes = std::make_unique<ElevationTopic>(context);
  // Updates are first in the list: where both are due, the last update of the old keyframe goes out before
  // the new keyframe.
  topics.push_back(std::make_unique<ElevationUpdatesTopic>(context, queue, *keyframes));
  topics.push_back(std::move(keyframes));
}

}  // namespace desert_sim
