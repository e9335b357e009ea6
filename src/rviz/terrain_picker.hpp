#pragma once
/// What the mouse points at on a node's terrain. Tools use it; it needs no display, but where a display
/// desert_sim/Terrain shows the same terrain, the mouse points at what is drawn, with the heights
/// exaggerated.

#include <memory>
#include <optional>
#include <string>

#include "include/desert_sim/client/terrain_client.hpp"
#include "src/render/ray_cast.hpp"
#include "src/rviz/placement.hpp"

namespace rviz {
class DisplayContext;
class ViewportMouseEvent;
}  // namespace rviz

namespace desert_sim {

class TerrainPicker {
 public:
  /// `context` must outlive the picker.
  explicit TerrainPicker(rviz::DisplayContext& context) : context_(context) {}

  /// Follows the terrain of this node, such as /desert_sim; an empty name follows none.
  void follow(const std::string& node);

  /// Takes over the newest map and the transforms of now. False if there is none of them; problem() says
  /// which. A map stays the same until the next call.
  bool update();
  /// Why update() was false.
  const std::string& problem() const { return problem_; }

  /// update(), and what the mouse points at; empty also where the mouse has left the view.
  std::optional<render::Point> hover(const rviz::ViewportMouseEvent& event);
  /// Whether the event is one that turns the view, if no tool needs it: alt, the middle or the right button.
  static bool turns_view(rviz::ViewportMouseEvent& event);
  /// Lets the present view handle the event.
  void give_to_view(rviz::ViewportMouseEvent& event) const;

  // ---- After update() was true. Places and points are relative to the south-west corner of the grid, with
  //      true heights.

  /// The terrain under the mouse; empty beside it.
  std::optional<render::Point> pick(const rviz::ViewportMouseEvent& event) const;
  const render::HeightField& field() const { return field_; }
  /// The map of that field.
  const std::shared_ptr<const ElevationMap>& map() const { return map_; }
  /// The same place in the terrain's frame.
  render::Place in_terrain_frame(const render::Point& point) const;
  double exaggeration() const { return exaggeration_; }
  /// Where the corner of the grid is drawn in the fixed frame.
  const Placement& corner() const { return corner_; }

 private:
  double exaggeration_of_display() const;

  rviz::DisplayContext& context_;
  std::string node_, problem_;
  std::shared_ptr<TerrainClient> client_;
  std::shared_ptr<const ElevationMap> map_;
  render::HeightField field_;
  double exaggeration_ = 1;
  Placement corner_;
};

}  // namespace desert_sim
