/// ~detail: what ripples and bumps between cells depend on, besides layers.

#include "src/ros/conversion/detail_message.hpp"
#include "src/ros/topics/topic_list.hpp"

namespace desert_sim {

namespace {

class DetailTopic : public MessageTopic<DetailState> {
 public:
  explicit DetailTopic(const TopicContext& context) : MessageTopic(context, "detail", queue) {}
  double rate() const override { return parameters().topics.detail_rate; }
  bool publish(const TerrainState& state) override {
    publisher_.publish(detail_message(state, frame()));
    return true;
  }

 private:
  static constexpr std::uint32_t queue = 100;  ///< a rover in lockstep needs each, and they are short
};

}  // namespace

void add_detail_topic(const TopicContext& context, TopicList& topics) {
  topics.push_back(std::make_unique<DetailTopic>(context));
}

}  // namespace desert_sim
