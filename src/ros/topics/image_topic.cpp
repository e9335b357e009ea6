/// ~image: the terrain from above as a shaded picture, through image_transport.

#include <image_transport/image_transport.h>

#include <boost/make_shared.hpp>

#include "src/io/snapshots.hpp"
#include "src/ros/conversion/messages.hpp"
#include "src/ros/topics/topic_list.hpp"

namespace desert_sim {

namespace {

sensor_msgs::ImagePtr image_message(const TerrainState& state, const std::string& frame) {
  const cv::Mat picture = hillshade_picture(to_picture_input(*state.snapshot));
  sensor_msgs::ImagePtr message = boost::make_shared<sensor_msgs::Image>();
  message->header = header_of(state.moment, frame);
  message->width = static_cast<std::uint32_t>(picture.cols);
  message->height = static_cast<std::uint32_t>(picture.rows);
  message->encoding = "bgr8";
  message->step = 3 * message->width;
  message->data.reserve(static_cast<std::size_t>(message->step) * message->height);
  for (int row = 0; row < picture.rows; ++row) {
    const std::uint8_t* first = picture.ptr<std::uint8_t>(row);
    message->data.insert(message->data.end(), first, first + message->step);
  }
  return message;
}

class ImageTopic : public Topic {
 public:
  explicit ImageTopic(const TopicContext& context) : Topic(context, "image") {
    publisher_ =
        image_transport::ImageTransport(context.node)
            .advertise("image", 1, [this](const image_transport::SingleSubscriberPublisher&) { request(); });
  }
  double rate() const override { return parameters().maps.parameters.image_rate; }
  std::uint32_t subscribers() const override { return publisher_.getNumSubscribers(); }
  std::vector<Layer> layers() const override {
    return {Layer::elevation, Layer::sand, Layer::vegetation,  Layer::obstacle,
            Layer::water,     Layer::soil, Layer::wind_shadow, Layer::plants};
  }
  bool publish(const TerrainState& state) override {
    publisher_.publish(image_message(state, frame()));
    return true;
  }

 private:
  image_transport::Publisher publisher_;
};

}  // namespace

void add_image_topic(const TopicContext& context, TopicList& topics) {
  topics.push_back(std::make_unique<ImageTopic>(context));
}

}  // namespace desert_sim
