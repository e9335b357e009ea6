#pragma once
/// Tells the panel that a tool in the same rviz has changed a node's timeline, of which ~status has only the
/// next entry.

#include <QObject>
#include <QString>
#include <string>

namespace desert_sim {

class TimelineNews : public QObject {
  Q_OBJECT

 public:
  static TimelineNews& instance();
  /// From any thread. `node`: its full name.
  static void tell(const std::string& node);

 Q_SIGNALS:
  void changed(const QString& node);
};

}  // namespace desert_sim
