#pragma once
/// The properties of the display desert_sim/Terrain, which its user edits in rviz's tree.

#include <rviz/properties/property.h>

#include <QObject>
#include <memory>

#include "src/render/level_of_detail.hpp"
#include "src/render/terrain_look.hpp"
#include "src/rviz/colour_properties.hpp"
#include "src/rviz/overlay_properties.hpp"

namespace rviz {
class BoolProperty;
class EnumProperty;
class FloatProperty;
class IntProperty;
class RosTopicProperty;
}  // namespace rviz

namespace desert_sim {

class TerrainProperties : public QObject {
  Q_OBJECT

 public:
  /// Below `parent`, which owns them.
  explicit TerrainProperties(rviz::Property* parent);

  rviz::RosTopicProperty& topic() { return *topic_; }
  double vertical_exaggeration() const;
  render::TerrainLook look() const;
  render::DetailLimits limits() const;
  /// Of work in each frame [s].
  double budget() const;
  bool ripples() const;       ///< as a picture
  bool micro_relief() const;  ///< as shapes
  bool sky() const;
  bool plants() const;
  int most_plants() const;
  bool wind() const;
  int most_arrows() const;
  bool fit_view() const;

  OverlayProperties& overlay() { return *overlay_; }
  OverlayProperties& second() { return *second_; }
  /// The map of the elevation that a change is compared with; null without any.
  std::shared_ptr<const LayerMap> reference() const;
  /// Takes note of the newest maps; see OverlayProperties.
  void see(const LayerMap& map);
  void see_elevation(const std::shared_ptr<const LayerMap>& map);
  /// Forgets all maps.
  void forget_maps();
  /// Takes over how a scenario wants to be shown: its colours, and whether its wind is seen. A user's own
  /// choice stays until a scenario comes that wants something else than the one before.
  void see(const Appearance& appearance);

 Q_SIGNALS:
  void topic_changed();
  void look_changed();    ///< of the ground
  void views_changed();   ///< what else is shown
  void limits_changed();  ///< of triangles

 private:
  void add_ground(rviz::Property* parent);
  void add_overlays(rviz::Property* parent);
  void add_views(rviz::Property* parent);
  void add_limits(rviz::Property* parent);

  rviz::RosTopicProperty* topic_;
  rviz::FloatProperty *exaggeration_, *contours_, *divide_, *budget_, *quad_pixels_;
  rviz::IntProperty *triangles_, *most_plants_, *most_arrows_;
  rviz::BoolProperty *materials_, *water_, *shadows_, *sky_, *ripples_, *micro_relief_, *plants_, *wind_,
      *fit_view_, *side_by_side_;
  rviz::EnumProperty* shading_;
  std::unique_ptr<OverlayProperties> overlay_, second_;
  std::unique_ptr<ColourProperties> colours_;
  bool wind_wanted_ = false;  ///< by the scenario
};

}  // namespace desert_sim
