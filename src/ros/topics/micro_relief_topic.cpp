/// ~micro_relief: what ripples and bumps between cells depend on, besides layers.

#include "src/ros/conversion/micro_relief_message.hpp"
#include "src/ros/topics/topic_list.hpp"

namespace desert_sim {

namespace {

class MicroReliefTopic : public MessageTopic<MicroReliefState> {
 public:
  explicit MicroReliefTopic(const TopicContext& context) : MessageTopic(context, "micro_relief", queue) {}
  double rate() const override { return parameters().topics.micro_relief_rate; }
  bool publish(const TerrainState& state) override {
    publisher_.publish(micro_relief_message(state, frame()));
    return true;
  }

 private:
  static constexpr std::uint32_t queue = 100;  ///< a rover in lockstep needs each, and they are short
};

}  // namespace

void add_micro_relief_topic(const TopicContext& context, TopicList& topics) {
  topics.push_back(std::make_unique<MicroReliefTopic>(context));
}

}  // namespace desert_sim
