/// ~appearance: the colours of materials, and whether the wind is to be seen.

#include <desert_sim/Appearance.h>

#include "src/ros/conversion/messages.hpp"
#include "src/ros/topics/topic_list.hpp"

namespace desert_sim {

namespace {

std_msgs::ColorRGBA message_of(const render::Colour& colour) {
  std_msgs::ColorRGBA m;
  m.r = colour.r;
  m.g = colour.g;
  m.b = colour.b;
  m.a = 1;
  return m;
}

class AppearanceTopic : public MessageTopic<Appearance> {
 public:
  explicit AppearanceTopic(const TopicContext& context) : MessageTopic(context, "appearance") {}
  double rate() const override { return parameters().topics.appearance_rate; }
  bool publish(const TerrainState& state) override {
    const Snapshot& s = *state.snapshot;
    Appearance m;
    m.header = header_of(state.moment, frame());
    m.step = s.step;
    m.sand = message_of(s.palette.sand);
    m.soil = message_of(s.palette.soil);
    m.weak_rock = message_of(s.palette.weak_rock);
    m.hard_rock = message_of(s.palette.hard_rock);
    m.obstacle = message_of(s.palette.obstacle);
    m.vegetation = message_of(s.palette.vegetation);
    m.shallow_water = message_of(s.palette.shallow_water);
    m.deep_water = message_of(s.palette.deep_water);
    m.wind_arrows = s.wind_arrows;
    publisher_.publish(m);
    return true;
  }
};

}  // namespace

void add_appearance_topic(const TopicContext& context, TopicList& topics) {
  topics.push_back(std::make_unique<AppearanceTopic>(context));
}

}  // namespace desert_sim
