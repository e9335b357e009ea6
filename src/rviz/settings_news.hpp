#pragma once
/// Tells the panel that something in the same rviz has changed a node's settings (its timeline, its species),
/// of which ~status does not tell all: the brush, an undo.

#include <QObject>
#include <QString>
#include <string>

namespace desert_sim {

class SettingsNews : public QObject {
  Q_OBJECT

 public:
  static SettingsNews& instance();
  /// From any thread. `node`: its full name.
  static void tell(const std::string& node);

 Q_SIGNALS:
  void changed(const QString& node);
};

}  // namespace desert_sim
