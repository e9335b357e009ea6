#pragma once
/// The line under a control that says what became of its last request.

#include <QLabel>
#include <string>

namespace desert_sim {

/// Takes no room while it has nothing to say. The property `refused` is for style sheets and tests.
class ErrorLine : public QLabel {
  Q_OBJECT
  Q_PROPERTY(bool refused READ refused)

 public:
  explicit ErrorLine(const QString& name, QWidget* parent = nullptr);

  void show_error(const std::string& message);  ///< red
  void show_note(const std::string& message);   ///< grey
  void show_nothing();
  bool refused() const { return refused_; }

 private:
  void set(const std::string& message, const char* colour);

  bool refused_ = false;
};

}  // namespace desert_sim
