#include "src/ros/forecast/forecast_messages.hpp"

#include <boost/make_shared.hpp>

#include "src/core/hash_text.hpp"
#include "src/ros/conversion/messages.hpp"

namespace desert_sim {

namespace {

/// What all maps of a forecast have in common.
class MapMaker {
 public:
  MapMaker(const ForecastMaps& forecast, const std_msgs::Header& header) : header_(header) {
    width_ = static_cast<std::uint32_t>(forecast.width);
    height_ = static_cast<std::uint32_t>(forecast.height);
    cell_size_ = forecast.cell_size;
    origin_.position.x = forecast.origin_x;
    origin_.position.y = forecast.origin_y;
    origin_.orientation.w = 1;
  }

  nav_msgs::OccupancyGrid costs(std::vector<std::int8_t>&& costs) const {
    nav_msgs::OccupancyGrid map;
    map.header = header_;
    map.info.map_load_time = header_.stamp;
    map.info.resolution = static_cast<float>(cell_size_);
    map.info.width = width_;
    map.info.height = height_;
    map.info.origin = origin_;
    map.data = std::move(costs);
    return map;
  }
  LayerGrid layer(const char* name, const char* unit, std::vector<float>&& values, std::uint64_t step,
                  double sim_time) const {
    LayerGrid map;
    map.header = header_;
    map.step = step;
    map.sim_time = sim_time;
    map.width = width_;
    map.height = height_;
    map.cell_size = cell_size_;
    map.origin = origin_;
    map.layer = name;
    map.unit = unit;
    map.data = std::move(values);
    return map;
  }

 private:
  std_msgs::Header header_;
  std::uint32_t width_ = 0, height_ = 0;
  double cell_size_ = 0;
  geometry_msgs::Pose origin_;
};

}  // namespace

ForecastPtr forecast_message(ForecastMaps&& forecast, const Moment& start, const std::string& frame) {
  ForecastPtr message = boost::make_shared<Forecast>();
  message->header = header_of(start, frame);
  message->step = forecast.step;
  message->sim_time = forecast.sim_time;
  message->seconds_per_sim_second = forecast.seconds_per_sim_second;
  message->members = static_cast<std::uint32_t>(forecast.members);
  const MapMaker maps(forecast, message->header);
  for (ForecastMoment& moment : forecast.moments) {
    message->times.push_back(moment.time);
    message->steps.push_back(moment.step);
    message->state_hashes.push_back(hash_text(moment.hash));
    message->costs.push_back(maps.costs(std::move(moment.costs)));
    message->elevation.push_back(
        maps.layer("elevation", "m", std::move(moment.elevation), moment.step, moment.sim_time));
    if (forecast.members > 1)
      message->probability.push_back(
          maps.layer("probability", "1", std::move(moment.probability), moment.step, moment.sim_time));
  }
  message->passable_until =
      maps.layer("passable_until", "s", std::move(forecast.passable_until), forecast.step, forecast.sim_time);
  message->passable_from =
      maps.layer("passable_from", "s", std::move(forecast.passable_from), forecast.step, forecast.sim_time);
  return message;
}

}  // namespace desert_sim
