/// ~wind: the wind at the surface, averaged over blocks of cells; ~wind_array: the same in a message that
/// bridges and viewers know.

#include <desert_sim/WindField.h>
#include <std_msgs/Float32MultiArray.h>

#include <algorithm>
#include <boost/make_shared.hpp>

#include "src/ros/conversion/messages.hpp"
#include "src/ros/topics/topic_list.hpp"

namespace desert_sim {

namespace {

/// The means of a layer over blocks of block × block cells, row-major; a block over the edge averages the
/// cells that it has. A layer that is not in use is 0.
std::vector<float> block_means(const Snapshot& s, Layer layer, int block, int columns, int rows) {
  std::vector<float> means(static_cast<std::size_t>(columns) * rows, 0.0f);
  const std::vector<float>* values = s.find(layer);
  if (!values) return means;
  if (block == 1) return *values;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int x1 = std::min(s.width, (column + 1) * block), y1 = std::min(s.height, (row + 1) * block);
      double sum = 0;
      for (int y = row * block; y < y1; ++y)
        for (int x = column * block; x < x1; ++x) sum += (*values)[static_cast<std::size_t>(y) * s.width + x];
      const int cells = (x1 - column * block) * (y1 - row * block);
      means[static_cast<std::size_t>(row) * columns + column] = static_cast<float>(sum / cells);
    }
  return means;
}

WindFieldPtr wind_message(const TerrainState& state, const std::string& frame, int decimation) {
  const Snapshot& s = *state.snapshot;
  const int block = std::min(decimation, std::max(s.width, s.height));
  const int columns = (s.width + block - 1) / block, rows = (s.height + block - 1) / block;
  WindFieldPtr message = boost::make_shared<WindField>();
  message->header = header_of(state.moment, frame);
  message->step = s.step;
  message->sim_time = s.time;
  message->width = static_cast<std::uint32_t>(columns);
  message->height = static_cast<std::uint32_t>(rows);
  message->cell_size = s.cell_size * block;
  message->origin = origin_of(s);
  message->u = block_means(s, Layer::wind_x, block, columns, rows);
  message->v = block_means(s, Layer::wind_y, block, columns, rows);
  message->above = vector_of(s.wind_above);
  return message;
}

/// 2 × height × width values [m/s]: eastward parts, then northward ones.
std_msgs::Float32MultiArrayPtr wind_array(const WindField& wind) {
  const auto array = boost::make_shared<std_msgs::Float32MultiArray>();
  const auto dimension = [&](const char* label, std::uint32_t size, std::uint32_t stride) {
    std_msgs::MultiArrayDimension axis;
    axis.label = label;
    axis.size = size;
    axis.stride = stride;
    array->layout.dim.push_back(axis);
  };
  const std::uint32_t cells = wind.height * wind.width;
  dimension("u, v", 2, 2 * cells);
  dimension("y", wind.height, cells);
  dimension("x", wind.width, wind.width);
  array->data.reserve(2 * std::size_t{cells});
  array->data.insert(array->data.end(), wind.u.begin(), wind.u.end());
  array->data.insert(array->data.end(), wind.v.begin(), wind.v.end());
  return array;
}

template <class Message>
class WindTopic : public MessageTopic<Message> {
 public:
  WindTopic(const TopicContext& context, const std::string& name) : MessageTopic<Message>(context, name) {}
  double rate() const override { return this->parameters().topics.wind_rate; }
  std::vector<Layer> layers() const override { return {Layer::wind_x, Layer::wind_y}; }

  bool publish(const TerrainState& state) override {
    const WindFieldPtr wind = wind_message(state, this->frame(), this->parameters().topics.wind_decimation);
    if constexpr (std::is_same_v<Message, WindField>)
      this->publisher_.publish(wind);
    else
      this->publisher_.publish(wind_array(*wind));
    return true;
  }
};

}  // namespace

void add_wind_topics(const TopicContext& context, TopicList& topics) {
  topics.push_back(std::make_unique<WindTopic<WindField>>(context, "wind"));
  topics.push_back(std::make_unique<WindTopic<std_msgs::Float32MultiArray>>(context, "wind_array"));
}

}  // namespace desert_sim
