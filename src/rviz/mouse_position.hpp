#pragma once
/// Where a mouse is in a widget.

#include <QMouseEvent>
#include <QPointF>

namespace desert_sim {

/// [pixels] from the widget's upper left corner.
inline QPointF position_of(const QMouseEvent& event) {
#if QT_VERSION >= QT_VERSION_CHECK(6, 0, 0)
  return event.position();
#else
  return event.localPos();
#endif
}

}  // namespace desert_sim
