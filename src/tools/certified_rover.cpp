/// Rovers and their sensors in the certificate.
#include <yaml-cpp/yaml.h>

#include <cmath>

#include "kernels/sand/repose.hpp"
#include "src/rover/rover.hpp"
#include "src/rover/rover_class.hpp"
#include "src/rover/sensors/depth_camera.hpp"
#include "src/rover/sensors/lidar.hpp"
#include "src/rover/simulated_ground.hpp"
#include "src/simulation/session.hpp"
#include "src/simulation/views/snapshot_source.hpp"
#include "src/tools/certified_hash.hpp"
#include "src/tools/digest.hpp"

namespace desert_sim {

namespace {

constexpr double yaw = 0.3;          // at the start
constexpr int ticks_of_step = 25;    // half a second on each state of the terrain
constexpr int steps_of_command = 8;  // four seconds

/// In turn: arcs to both sides, ahead, back, on the spot, and sideways, which most rovers cannot.
constexpr DriveCommand commands[] = {{0.3, 0, 0.1},  {0.3, 0, -0.1}, {0.5, 0, 0},
                                     {-0.2, 0, 0.2}, {0, 0, 0.4},    {0.1, 0.2, 0}};

Rover noisy_rover(const CertifiedRun& run, const Scenario& scenario) {
  const std::string file = rover_file(run.rover);
  RoverParameters parameters = rover_of_class(YAML::LoadFile(file), file);
  parameters.odometry_noise = 0.05;
  parameters.gyro_noise = 0.01;
  parameters.accelerometer_noise = 0.05;
  const auto& repose = scenario.get<ReposeParameters>();
  return Rover(parameters, {}, file,
               {static_cast<double>(repose.half_wet), static_cast<double>(repose.saturated)});
}

/// The scene that beams meet, and where the sensors stand in it: above its middle, tilted.
struct SensorScene {
  SensorScene(const CertifiedRun& run, const CertifiedPlace& place)
      : session(certified_scenario(run), place.load_raster, place.backend, place.threads) {
    for (std::uint64_t n = 0; n < run.steps; ++n) session.step();
    std::vector<Layer> layers = MicroRelief::layers();
    layers.insert(layers.end(),
                  {Layer::elevation, Layer::canopy_height, Layer::vegetation, Layer::airborne_sand});
    const auto s = session.simulation().views().snapshot(layers, {}, true);
    scene = std::make_unique<HeightFieldScene>(
        session.simulation().exec(),
        SceneGeometry{s->width, s->height, s->cell_size, s->origin_x, s->origin_y});
    const auto show = [&](SceneLayer shown, Layer layer) {
      if (const std::vector<float>* values = s->find(layer)) scene->update(shown, *values);
    };
    show(SceneLayer::elevation, Layer::elevation);
    show(SceneLayer::canopy_height, Layer::canopy_height);
    show(SceneLayer::vegetation, Layer::vegetation);
    show(SceneLayer::airborne_sand, Layer::airborne_sand);
    scene->set_micro_relief(source_of(*s));
    const std::vector<float>& elevation = *s->find(Layer::elevation);
    const auto middle = static_cast<std::size_t>(s->height / 2) * static_cast<std::size_t>(s->width) +
                        static_cast<std::size_t>(s->width / 2);
    const double ground = static_cast<double>(elevation[middle]);
    pose = pose_from_angles(s->origin_x + 0.5 * s->cell_size * s->width,
                            s->origin_y + 0.5 * s->cell_size * s->height, ground + 1.5, 3, -4, 30);
  }
  Session session;
  std::unique_ptr<HeightFieldScene> scene;
  SensorPose pose;
};

/// Of two scans, from the sensor's place on a rover.
template <class Sensor, class Parameters>
std::uint64_t hash_of_scans(const CertifiedRun& run, const CertifiedPlace& place,
                            const Parameters& parameters) {
  SensorScene at(run, place);
  Sensor sensor(at.session.simulation().exec(), parameters);
  Digest digest;
  for (const std::uint64_t number : {1, 2}) {
    const RangeImage& image = sensor.scan(*at.scene, compose(at.pose, mounting_of(parameters)), number);
    for (const float distance : image.distances) digest.add(std::isnan(distance) ? -1.0F : distance);
    digest.add(image.intensities);
  }
  return digest.value();
}

}  // namespace

std::uint64_t rover_hash(const CertifiedRun& run, const CertifiedPlace& place) {
  Scenario scenario = certified_scenario(run);
  resolve_grid(scenario, place.load_raster);
  Rover rover = noisy_rover(run, scenario);
  SimulatedGround terrain(scenario, place.load_raster, place.backend, place.threads, true);
  const GridParameters& grid = scenario.grid;
  rover.place(grid.origin_x + 0.5 * grid.cell_size * grid.width,
              grid.origin_y + 0.5 * grid.cell_size * grid.height, yaw, terrain.at(0));
  Digest digest;
  for (std::uint64_t step = 0; step < run.steps; ++step) {
    const GroundSource& ground = terrain.at(step);
    if (step % steps_of_command == 0)
      rover.drive(commands[step / steps_of_command % std::size(commands)], Rover::longest_advance);
    for (int tick = 0; tick < ticks_of_step; ++tick) {
      rover.advance(Rover::internal_step, &ground);
      digest.add(hash_of(rover.state()));
      const ImuReading imu = rover.imu();
      for (const double value : imu.angular_velocity) digest.add(value);
      for (const double value : imu.acceleration) digest.add(value);
    }
  }
  return digest.value();
}

std::uint64_t lidar_hash(const CertifiedRun& run, const CertifiedPlace& place) {
  LidarParameters parameters;
  parameters.columns = 512;
  parameters.noise_per_metre = 0.001F;
  parameters.dropout = 0.01F;
  return hash_of_scans<Lidar>(run, place, parameters);
}

std::uint64_t depth_camera_hash(const CertifiedRun& run, const CertifiedPlace& place) {
  DepthCameraParameters parameters;
  parameters.dropout = 0.01F;
  return hash_of_scans<DepthCamera>(run, place, parameters);
}

}  // namespace desert_sim
