/// ~wind: the wind at the surface, averaged over blocks of cells.

#include <desert_sim/WindField.h>

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

class WindTopic : public MessageTopic<WindField> {
 public:
  explicit WindTopic(const TopicContext& context) : MessageTopic(context, "wind") {}
  double rate() const override { return parameters().topics.wind_rate; }
  std::vector<Layer> layers() const override { return {Layer::wind_x, Layer::wind_y}; }

  bool publish(const TerrainState& state) override {
    publisher_.publish(wind_message(state, frame(), parameters().topics.wind_decimation));
    return true;
  }
};

}  // namespace

void add_wind_topic(const TopicContext& context, TopicList& topics) {
  topics.push_back(std::make_unique<WindTopic>(context));
}

}  // namespace desert_sim
