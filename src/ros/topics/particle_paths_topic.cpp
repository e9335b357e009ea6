/// ~particle_paths: the ways of grains of the particle model, as lines for rviz.

#include <visualization_msgs/Marker.h>

#include "src/ros/conversion/messages.hpp"
#include "src/ros/topics/topic_list.hpp"

namespace desert_sim {

namespace {

using visualization_msgs::Marker;

geometry_msgs::Point point_of(const ParticlePaths& paths, const particles::PathPoint& p,
                              const ViewFrame& frame) {
  geometry_msgs::Point point;
  point.x = paths.origin_x + static_cast<double>(p.x) - frame.x;
  point.y = paths.origin_y + static_cast<double>(p.y) - frame.y;
  point.z = static_cast<double>(p.z) - frame.z;
  return point;
}

/// A line for each step of each way; a marker without points takes away what was shown before.
Marker marker_of(const TerrainState& state, const ViewFrame& frame) {
  Marker m;
  m.header = header_of(state.moment, frame.name);
  m.ns = "particle_paths";
  m.type = Marker::LINE_LIST;
  m.pose.orientation.w = 1;
  m.scale.x = 0.05 * state.snapshot->cell_size;
  m.color.r = m.color.g = 1;
  m.color.b = 0.9F;
  m.color.a = 1;
  const ParticlePaths& all = *state.particle_paths;
  for (const std::vector<particles::PathPoint>& path : all.paths)
    for (std::size_t n = 0; n + 1 < path.size(); ++n) {
      m.points.push_back(point_of(all, path[n], frame));
      m.points.push_back(point_of(all, path[n + 1], frame));
    }
  m.action = m.points.empty() ? Marker::DELETE : Marker::ADD;
  return m;
}

class ParticlePathsTopic : public MessageTopic<Marker> {
 public:
  explicit ParticlePathsTopic(const TopicContext& context) : MessageTopic(context, "particle_paths") {}
  double rate() const override { return parameters().topics.particle_paths_rate; }
  void add_to(StateQuery& query) override { query.particle_paths = parameters().topics.particle_paths_count; }
  bool publish(const TerrainState& state) override {
    publisher_.publish(marker_of(state, view_frame()));
    return true;
  }
};

}  // namespace

void add_particle_paths_topic(const TopicContext& context, TopicList& topics) {
  topics.push_back(std::make_unique<ParticlePathsTopic>(context));
}

}  // namespace desert_sim
