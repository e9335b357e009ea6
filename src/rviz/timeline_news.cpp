#include "src/rviz/timeline_news.hpp"

namespace desert_sim {

TimelineNews& TimelineNews::instance() {
  static TimelineNews one;
  return one;
}

void TimelineNews::tell(const std::string& node) { Q_EMIT instance().changed(QString::fromStdString(node)); }

}  // namespace desert_sim
