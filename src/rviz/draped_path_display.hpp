#pragma once
/// The display desert_sim/DrapedPath of rviz: a nav_msgs/Path on the ground.

#include <nav_msgs/Path.h>

#include "src/rviz/draped_line_display.hpp"
#include "src/rviz/topic_inbox.hpp"

namespace desert_sim {

class DrapedPathDisplay : public DrapedLineDisplay {
  Q_OBJECT

 public:
  DrapedPathDisplay();

 protected:
  void receive(const std::string& topic) override { inbox_.subscribe(threaded_nh_, topic); }
  bool connected() const override { return inbox_.connected(); }
  std::optional<Line> take() override;

 private:
  TopicInbox<nav_msgs::Path> inbox_;
};

}  // namespace desert_sim
