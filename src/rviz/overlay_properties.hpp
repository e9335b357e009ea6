#pragma once
/// The properties of the display's overlay: which layer is shown, with which range and colours.

#include <rviz/properties/property.h>

#include <QObject>

#include "include/desert_sim/client/layer_map.hpp"
#include "src/render/change_reference.hpp"
#include "src/render/overlay.hpp"

namespace rviz {
class BoolProperty;
class EditableEnumProperty;
class EnumProperty;
class FloatProperty;
}  // namespace rviz

namespace desert_sim {

class OverlayProperties : public QObject {
  Q_OBJECT

 public:
  /// Below `parent`, which owns the properties; `name` is that of the property that has all others.
  OverlayProperties(const QString& name, const QString& what, rviz::Property* parent);
  rviz::Property* property() const;

  /// The overlay as it is to be drawn; not active if none is chosen.
  render::Overlay overlay() const;
  bool legend() const;
  /// Such as "wind_shadow" or "change since step 100 [m]".
  std::string title() const;

  /// Takes note of the newest map of a layer: it decides the automatic range when it is the first one of the
  /// chosen layer, and whether the change of the elevation is compared with another map from now on.
  void see(const LayerMap& map);
  void see_elevation(const std::shared_ptr<const LayerMap>& map);
  /// Forgets the maps that changes are compared with.
  void clear();
  bool shows_change() const;
  /// The map of the elevation that the change is compared with; null without any.
  std::shared_ptr<const LayerMap> reference() const { return shown_reference_; }

 Q_SIGNALS:
  /// Something that is drawn is another one now.
  void changed();

 private Q_SLOTS:
  void choose_layer();
  void choose_range();
  void choose_period();
  void mark();

 private:
  void set_range(float low, float high);
  void compare_again();

  rviz::EditableEnumProperty* layer_;
  rviz::BoolProperty *automatic_, *legend_, *mark_;
  rviz::FloatProperty *low_, *high_, *opacity_, *period_;
  rviz::EnumProperty* colours_;

  bool range_wanted_ = true;  ///< the next map of the layer decides the range
  render::ChangeReference<LayerMap> history_;
  std::shared_ptr<const LayerMap> shown_reference_;
};

}  // namespace desert_sim
