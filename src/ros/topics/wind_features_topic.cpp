/// ~wind_features: the local features of the wind, with the ids that ~edit_wind knows them by.

#include <desert_sim/WindFeatureList.h>

#include <boost/make_shared.hpp>

#include "src/ros/conversion/messages.hpp"
#include "src/ros/topics/topic_list.hpp"

namespace desert_sim {

namespace {

WindFeatureItem message_of(const WindFeature& feature) {
  WindFeatureItem m;
  m.id = feature.id;
  m.kind = wind_feature_kinds[static_cast<int>(feature.kind)];
  m.center.x = feature.x;
  m.center.y = feature.y;
  m.radius = static_cast<double>(feature.radius);
  m.speed = static_cast<double>(feature.speed);
  m.begin = feature.begin;
  m.end = feature.end;
  m.velocity.x = static_cast<double>(feature.velocity_x);
  m.velocity.y = static_cast<double>(feature.velocity_y);
  for (const WindPathPoint& point : feature.path) {
    WindFeaturePoint& there = m.path.emplace_back();
    there.time = point.time;
    there.x = point.x;
    there.y = point.y;
  }
  if (feature.kind == WindFeatureKind::jet) {
    m.direction_deg = static_cast<double>(feature.direction_deg);
    m.length = static_cast<double>(feature.length);
  }
  if (feature.kind == WindFeatureKind::turbulence) {
    m.scale = static_cast<double>(feature.scale);
    m.life_time = static_cast<double>(feature.life_time);
    m.seed = feature.seed;
  }
  return m;
}

constexpr const char* wind_features_topic = "wind_features";

class WindFeaturesTopic : public MessageTopic<WindFeatureList> {
 public:
  WindFeaturesTopic(const TopicContext& context, ros::Publisher latched)
      : MessageTopic(context, wind_features_topic), latched_(latched) {}
  double rate() const override { return parameters().topics.wind_features_rate; }
  bool publish(const TerrainState& state) override {
    const auto message = boost::make_shared<WindFeatureList>();
    message->header = header_of(state.moment, frame());
    message->step = state.snapshot->step;
    message->sim_time = state.snapshot->time;
    for (const WindFeature& feature : state.snapshot->wind_features)
      message->features.push_back(message_of(feature));
    publisher_.publish(message);
    return true;
  }

 private:
  ros::Publisher latched_;  ///< publishes nothing: see add_wind_features_topic()
};

}  // namespace

void add_wind_features_topic(const TopicContext& context, TopicList& topics) {
  // rviz has two subscribers in one process, a tool and the panel; see add_costmap_topics().
  ros::NodeHandle node = context.node;
  const ros::Publisher latched = node.advertise<WindFeatureList>(wind_features_topic, 1, true);
  topics.push_back(std::make_unique<WindFeaturesTopic>(context, latched));
}

}  // namespace desert_sim
