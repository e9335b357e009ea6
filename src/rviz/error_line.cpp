#include "src/rviz/error_line.hpp"

namespace desert_sim {

ErrorLine::ErrorLine(const QString& name, QWidget* parent) : QLabel(parent) {
  setObjectName(name);
  setWordWrap(true);
  setTextFormat(Qt::PlainText);  // what a service says is not to be taken for markup
  setTextInteractionFlags(Qt::TextSelectableByMouse);
  setVisible(false);
}

void ErrorLine::show_error(const std::string& message) {
  refused_ = true;
  set(message, "#c62828");
}

void ErrorLine::show_note(const std::string& message) {
  refused_ = false;
  set(message, "#757575");
}

void ErrorLine::show_nothing() {
  refused_ = false;
  set("", "");
}

void ErrorLine::set(const std::string& message, const char* colour) {
  setStyleSheet(QStringLiteral("color: %1").arg(colour));
  setText(QString::fromStdString(message));
  setVisible(!message.empty());
}

}  // namespace desert_sim
