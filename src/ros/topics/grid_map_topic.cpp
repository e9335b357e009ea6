/// ~grid_map: layers of the terrain, or of a region of it, as a grid_map_msgs/GridMap.

#include <boost/make_shared.hpp>

#include "src/ros/conversion/grid_map_message.hpp"
#include "src/ros/topics/topic_list.hpp"

namespace desert_sim {

namespace {

class GridMapTopic : public MessageTopic<GridMap> {
 public:
  explicit GridMapTopic(const TopicContext& context) : MessageTopic(context, "grid_map") {}
  double rate() const override { return map().grid_map_rate; }
  std::vector<Layer> layers() const override {
    return shows_all() ? layers_of(shown_layers()) : std::vector<Layer>();
  }
  bool publish(const TerrainState& state) override {
    if (!shows_all()) return publish_or_set_problem([this] { publish_region(); });
    publish_cells(state, whole_window(*state.snapshot));
    return true;
  }

 private:
  const MapParameters& map() const { return parameters().maps.parameters; }
  const std::vector<MapLayer>& shown_layers() const { return parameters().maps.grid_map_layers; }
  /// Whether it shows the whole terrain.
  bool shows_all() const { return map().grid_map_length_x == 0; }

  /// Asks for the region itself: then only its rows are computed and copied.
  void publish_region() {
    const MapCut cut =
        cut_terrain(context().simulation, shown_layers(), short_name(), [this](const Snapshot& terrain) {
          const MapParameters& p = map();
          return window_of({p.grid_map_x, p.grid_map_y, p.grid_map_length_x, p.grid_map_length_y}, terrain);
        });
    publish_cells(cut.state, cut.window);
  }
  void publish_cells(const TerrainState& state, const MapWindow& window) {
    publisher_.publish(boost::make_shared<GridMap>(
        grid_map(state, frame(), shown_layers(), window, map().grid_map_decimation)));
  }
};

}  // namespace

void add_grid_map_topic(const TopicContext& context, TopicList& topics) {
  topics.push_back(std::make_unique<GridMapTopic>(context));
}

}  // namespace desert_sim
