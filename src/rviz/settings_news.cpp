#include "src/rviz/settings_news.hpp"

namespace desert_sim {

SettingsNews& SettingsNews::instance() {
  static SettingsNews one;
  return one;
}

void SettingsNews::tell(const std::string& node) { Q_EMIT instance().changed(QString::fromStdString(node)); }

}  // namespace desert_sim
