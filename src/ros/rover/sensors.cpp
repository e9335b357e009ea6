#include "src/ros/rover/sensors.hpp"

#include <chrono>
#include <cmath>

namespace desert_sim {

namespace {

/// In the order of SceneLayer.
constexpr const char* layer_names[] = {"elevation", "canopy_height", "vegetation", "airborne_sand"};

SceneGeometry geometry_of(const LayerMap& map) {
  const LayerMap::Info& info = map.info();
  return {static_cast<int>(info.width), static_cast<int>(info.height), info.cell_size, info.origin_x,
          info.origin_y};
}

/// The number of the interval of 1/rate in which a time lies; one that is meant to be on its boundary may be
/// off by rounding.
std::uint64_t interval_of(double time, double rate) {
  return static_cast<std::uint64_t>(std::floor(time * rate + 1e-6));
}

double milliseconds_since(const std::chrono::steady_clock::time_point& begin) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

std_msgs::Header header_at(const ros::Time& stamp, const std::string& frame) {
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = frame;
  return header;
}

}  // namespace

SensorPublisher::SensorPublisher(ros::NodeHandle node, const SensorSetup& setup, const SensorFrames& frames)
    : setup_(setup),
      frames_(frames),
      exec_(make_exec(setup.backend, setup.threads)),
      lidar_(*exec_, setup.lidar, setup.media),
      camera_(*exec_, setup.depth_camera, setup.media) {
  const std::uint32_t queue = setup_.lockstep ? 100 : 2;  // in lockstep a lost message is missed
  if (setup_.lidar.rate > 0) points_ = node.advertise<sensor_msgs::PointCloud2>("lidar/points", queue);
  if (setup_.depth_camera.rate > 0) {
    image_ = node.advertise<sensor_msgs::Image>("depth_camera/image_rect", queue);
    info_ = node.advertise<sensor_msgs::CameraInfo>("depth_camera/camera_info", queue);
  }
  if (!setup_.lockstep) thread_ = std::thread([this] { work(); });
}

SensorPublisher::~SensorPublisher() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

std::vector<std::string> SensorPublisher::layers() {
  return {std::begin(layer_names), std::end(layer_names)};
}

void SensorPublisher::on_terrain(std::shared_ptr<const LayerMap> map, const LayerMap::Rectangle& changed) {
  for (std::size_t n = 0; n < layer_count; ++n) {
    if (map->info().layer != layer_names[n]) continue;
    const std::lock_guard<std::mutex> lock(mutex_);
    LayerState& layer = layers_[n];
    if (layer.map && layer.map->same_geometry(*map))
      layer.changed.include(changed);
    else
      layer.changed = {0, 0, map->info().width, map->info().height};
    layer.map = std::move(map);
    return;
  }
}

void SensorPublisher::on_micro_relief(std::shared_ptr<const MapMicroRelief> micro_relief) {
  const std::lock_guard<std::mutex> lock(mutex_);
  micro_relief_ = std::move(micro_relief);
}

bool SensorPublisher::has_subscribers() const {
  return points_.getNumSubscribers() + image_.getNumSubscribers() + info_.getNumSubscribers() > 0;
}

SensorPublisher::Job SensorPublisher::due(const ros::Time& stamp, const SensorPose& base,
                                          const std::optional<TimeSpan>& passed) {
  Job job{stamp, base, {}, {}};
  const double time = passed ? passed->end : static_cast<double>(stamp.toNSec()) * 1e-9;
  const auto next = [&](double rate, std::optional<std::uint64_t>& last, std::uint32_t subscribers) {
    std::optional<std::uint64_t> number;
    if (rate <= 0) return number;
    const std::uint64_t now = interval_of(time, rate);
    if (passed) last = interval_of(passed->begin, rate);
    if (subscribers > 0 && last != now) number = now;
    if (subscribers > 0) last = now;
    return number;
  };
  job.scan = next(setup_.lidar.rate, last_scan_, points_.getNumSubscribers());
  job.picture =
      next(setup_.depth_camera.rate, last_picture_, image_.getNumSubscribers() + info_.getNumSubscribers());
  return job;
}

void SensorPublisher::on_pose(const ros::Time& stamp, const geometry_msgs::Pose& base_in_terrain,
                              const std::optional<TimeSpan>& passed) {
  const SensorPose base = to_sensor_pose(base_in_terrain);
  rotation_of(base);  // refuses what is no pose
  Job job = due(stamp, base, passed);
  if (setup_.lockstep) {
    if (job.scan || job.picture) perform(job);
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (failure_) std::rethrow_exception(failure_);
    if (!job.scan && !job.picture) return;
    if (job_) {
      statistics_.skipped += (job_->scan && job.scan) + (job_->picture && job.picture);
      if (!job.scan) job.scan = job_->scan;
      if (!job.picture) job.picture = job_->picture;
    }
    job_ = job;
  }
  wake_.notify_one();
}

SensorPublisher::Statistics SensorPublisher::statistics() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return statistics_;
}

void SensorPublisher::work() {
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    wake_.wait(lock, [this] { return stopping_ || job_; });
    if (stopping_) return;
    const Job job = *job_;
    job_.reset();
    lock.unlock();
    try {
      perform(job);
    } catch (...) {
      lock.lock();
      failure_ = std::current_exception();  // for the next on_pose()
      return;
    }
    lock.lock();
  }
}

void SensorPublisher::perform(const Job& job) {
  if (!update_scene()) return;
  if (job.scan) publish_scan(job);
  if (job.picture) publish_picture(job);
}

/// Brings the scene up to date; false before the first elevation.
bool SensorPublisher::update_scene() {
  Layers layers;
  std::shared_ptr<const MapMicroRelief> micro_relief;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    layers = layers_;
    micro_relief = micro_relief_;
    for (LayerState& layer : layers_) layer.changed = {};
  }
  if (!layers[0].map) return false;
  const SceneGeometry geometry = geometry_of(*layers[0].map);
  if (!scene_ || !(scene_->geometry() == geometry)) {
    scene_ = std::make_unique<HeightFieldScene>(*exec_, geometry);
    scene_micro_relief_.reset();
    for (LayerState& layer : layers)
      if (layer.map) layer.changed = {0, 0, layer.map->info().width, layer.map->info().height};
  }
  std::uint64_t uploads = 0;
  for (std::size_t n = 0; n < layer_count; ++n) {
    // A layer of another geometry is older or newer than the elevation, and is told anew when that changes.
    if (!layers[n].map || layers[n].changed.empty() || !layers[n].map->same_geometry(*layers[0].map))
      continue;
    const LayerMap::Rectangle& r = layers[n].changed;
    scene_->update(
        static_cast<SceneLayer>(n),
        {static_cast<int>(r.x), static_cast<int>(r.y), static_cast<int>(r.width), static_cast<int>(r.height)},
        layers[n].map->values(r));
    ++uploads;
  }
  update_micro_relief(micro_relief);
  const std::lock_guard<std::mutex> lock(mutex_);
  statistics_.uploads += uploads;
  return true;
}

void SensorPublisher::update_micro_relief(const std::shared_ptr<const MapMicroRelief>& micro_relief) {
  if (micro_relief == scene_micro_relief_) return;
  scene_micro_relief_ = micro_relief;
  if (micro_relief && micro_relief->geometry() == scene_->geometry())
    scene_->set_micro_relief(micro_relief);
  else
    scene_->clear_micro_relief();
}

void SensorPublisher::publish_scan(const Job& job) {
  const auto begin = std::chrono::steady_clock::now();
  const RangeImage& scan = lidar_.scan(*scene_, compose(job.base, mounting_of(setup_.lidar)), *job.scan);
  points_.publish(lidar_cloud(header_at(job.stamp, frames_.lidar), scan, lidar_.directions()));
  const std::lock_guard<std::mutex> lock(mutex_);
  ++statistics_.scans;
  statistics_.last_scan_ms = milliseconds_since(begin);
}

void SensorPublisher::publish_picture(const Job& job) {
  const auto begin = std::chrono::steady_clock::now();
  const RangeImage& picture =
      camera_.scan(*scene_, compose(job.base, mounting_of(setup_.depth_camera)), *job.picture);
  const std_msgs::Header header = header_at(job.stamp, frames_.camera_optical);
  image_.publish(depth_image(header, picture));
  info_.publish(camera_info(header, camera_));
  const std::lock_guard<std::mutex> lock(mutex_);
  ++statistics_.pictures;
  statistics_.last_picture_ms = milliseconds_since(begin);
}

}  // namespace desert_sim
