#include "src/rover/urdf.hpp"

#include <limits>
#include <sstream>

#include "src/core/constants.hpp"

namespace desert_sim {

std::string wheel_name(int wheel, int wheels) {
  const int row = wheel / 2;
  const std::string place = row == 0 ? "front" : row == wheels / 2 - 1 ? "rear" : "middle";
  return place + (wheel % 2 == 0 ? "_left" : "_right");
}

namespace {

std::string side_name(int side) { return side == 0 ? "_left" : "_right"; }

/// Writes links and joints.
class Model {
 public:
  Model(const RoverParameters& rover, std::string prefix)
      : rover_(rover), suspension_(rover), prefix_(std::move(prefix)) {}

  std::string text(const LidarParameters& lidar, const DepthCameraParameters& depth_camera) {
    out_ << "<?xml version=\"1.0\"?>\n<!-- Written by desert_rover_node. Lengths in metres. -->\n"
            "<robot name=\"rover\">\n";
    for (const auto& [name, colour] :
         {std::pair("body", "0.85 0.82 0.75"), std::pair("frame", "0.35 0.35 0.38"),
          std::pair("wheel", "0.15 0.15 0.16")})
      out_ << "  <material name=\"" << name << "\"><color rgba=\"" << colour << " 1\"/></material>\n";
    body();
    for (int side = 0; side < 2; ++side) rocker(side);
    for (int wheel = 0; wheel < suspension_.wheels(); ++wheel) this->wheel(wheel);
    if (lidar.rate > 0)
      sensor("lidar", lidar,
             "<visual><geometry><cylinder radius=\"0.04\" length=\"0.08\"/></geometry><material "
             "name=\"wheel\"/></visual>");
    if (depth_camera.rate > 0) {
      sensor("depth_camera", depth_camera, box({-0.01, 0, 0}, {0.02, 0.09, 0.025}, "wheel"));
      link("depth_camera_optical", "");
      fixed_joint("depth_camera_optical", "depth_camera", {0, 0, 0}, {-pi / 2, 0, -pi / 2});
    }
    out_ << "</robot>\n";
    return out_.str();
  }

 private:
  static std::string xyz(const Eigen::Vector3d& p) {
    std::ostringstream text;
    text.precision(std::numeric_limits<double>::digits10);  // for who compares with the node's transforms
    text << p.x() << " " << p.y() << " " << p.z();
    return text.str();
  }
  void link(const std::string& name, const std::string& content) {
    out_ << "  <link name=\"" << prefix_ << name << "\">" << content << "</link>\n";
  }
  void joint(const std::string& name, const char* type, const std::string& parent, const std::string& child,
             const Eigen::Vector3d& at, const char* axis = nullptr) {
    out_ << "  <joint name=\"" << name << "\" type=\"" << type << "\"><parent link=\"" << prefix_ << parent
         << "\"/><child link=\"" << prefix_ << child << "\"/><origin xyz=\"" << xyz(at)
         << "\" rpy=\"0 0 0\"/>";
    if (axis) out_ << "<axis xyz=\"" << axis << "\"/>";
    out_ << "</joint>\n";
  }
  void fixed_joint(const std::string& child, const std::string& parent, const Eigen::Vector3d& at,
                   const Eigen::Vector3d& angles) {
    out_ << "  <joint name=\"" << child << "_joint\" type=\"fixed\"><parent link=\"" << prefix_ << parent
         << "\"/><child link=\"" << prefix_ << child << "\"/><origin xyz=\"" << xyz(at) << "\" rpy=\""
         << xyz(angles) << "\"/></joint>\n";
  }
  template <class Sensor>
  void sensor(const std::string& name, const Sensor& s, const std::string& shape) {
    constexpr double degree = pi / 180;
    link(name, shape);
    fixed_joint(name, "base_link", {s.x, s.y, s.z},
                {s.roll_deg * degree, s.pitch_deg * degree, s.yaw_deg * degree});
  }
  static std::string box(const Eigen::Vector3d& at, const Eigen::Vector3d& size, const char* material) {
    return "<visual><origin xyz=\"" + xyz(at) + "\"/><geometry><box size=\"" + xyz(size) +
           "\"/></geometry><material name=\"" + material + "\"/></visual>";
  }

  void body() {
    const double low = rover_.clearance - rover_.wheel_radius;
    const Eigen::Vector3d at{0, 0, low + rover_.body_height / 2},
        size{rover_.body_length, rover_.body_width, rover_.body_height};
    std::ostringstream inertial;
    const double m = rover_.mass, x = size.x() * size.x(), y = size.y() * size.y(), z = size.z() * size.z();
    inertial << "<inertial><origin xyz=\"" << xyz({0, 0, rover_.mass_height - rover_.wheel_radius})
             << "\"/><mass value=\"" << m << "\"/><inertia ixx=\"" << m * (y + z) / 12
             << "\" ixy=\"0\" ixz=\"0\" iyy=\"" << m * (x + z) / 12 << "\" iyz=\"0\" izz=\""
             << m * (x + y) / 12 << "\"/></inertial>";
    const std::string mast = box({size.x() * 0.35, 0, low + size.z() * 1.25},
                                 {size.x() * 0.08, size.y() * 0.15, size.z() * 0.5}, "frame");
    // The root of a model should have no mass, for KDL.
    link("base_link", box(at, size, "body") + mast);
    link("base_inertia", inertial.str());
    joint("base_inertia_joint", "fixed", "base_link", "base_inertia", {0, 0, 0});
  }
  /// From `ahead` to `behind`, in the frame of the arm's pivot.
  static std::string arm(double ahead, double behind, double z, double thickness) {
    return box({(ahead + behind) / 2, 0, z}, {ahead - behind, thickness, thickness}, "frame");
  }
  double side_y(int side) const {
    return (side == 0 ? 0.5 : -0.5) * (rover_.track - rover_.wheel_width) * 0.9;
  }
  bool has_bogies() const { return suspension_.wheels() == 6; }

  void rocker(int side) {
    const double half = rover_.wheelbase / 2, t = rover_.wheel_radius * 0.3;
    const std::string name = "rocker" + side_name(side);
    const double behind = has_bogies() ? rover_.bogie_x : -half;
    link(name, arm(half - rover_.pivot_x, behind - rover_.pivot_x, -rover_.pivot_height / 2, t));
    joint(name + "_joint", "continuous", "base_link", name,
          {rover_.pivot_x, side_y(side), rover_.pivot_height}, "0 1 0");
    if (!has_bogies()) return;
    const std::string bogie = "bogie" + side_name(side);
    link(bogie, arm(rover_.middle_x - rover_.bogie_x, -half - rover_.bogie_x, -rover_.bogie_height / 2, t));
    joint(bogie + "_joint", "continuous", name, bogie,
          {rover_.bogie_x - rover_.pivot_x, 0, rover_.bogie_height - rover_.pivot_height}, "0 1 0");
  }

  void wheel(int n) {
    const std::string name = wheel_name(n, suspension_.wheels());
    const int side = n % 2;
    const Eigen::Vector3d& hub = suspension_.hub_at_rest(n);
    const bool on_bogie = has_bogies() && n >= 2;
    const std::string parent = (on_bogie ? "bogie" : "rocker") + side_name(side);
    const Eigen::Vector3d at{hub.x() - (on_bogie ? rover_.bogie_x : rover_.pivot_x), hub.y() - side_y(side),
                             on_bogie ? -rover_.bogie_height : -rover_.pivot_height};
    std::string carrier = parent;
    Eigen::Vector3d place = at;
    if (rover_.steering != Steering::skid) {
      carrier = name + "_steer";
      link(carrier, "");
      joint(carrier + "_joint", "continuous", parent, carrier, at, "0 0 1");
      place.setZero();
    }
    std::ostringstream shape;
    shape << "<visual><origin xyz=\"0 0 0\" rpy=\"1.5707963267948966 0 0\"/><geometry><cylinder radius=\""
          << rover_.wheel_radius << "\" length=\"" << rover_.wheel_width
          << "\"/></geometry><material name=\"wheel\"/></visual>"
          << box({0, 0, 0}, {rover_.wheel_radius * 1.2, rover_.wheel_width * 1.05, rover_.wheel_radius * 0.3},
                 "frame");
    link(name + "_wheel", shape.str());
    joint(name + "_wheel_joint", "continuous", carrier, name + "_wheel", place, "0 1 0");
  }

  const RoverParameters rover_;
  const Suspension suspension_;
  const std::string prefix_;
  std::ostringstream out_;
};

}  // namespace

std::string urdf_of(const RoverParameters& rover, const LidarParameters& lidar,
                    const DepthCameraParameters& depth_camera, const std::string& prefix) {
  return Model(rover, prefix).text(lidar, depth_camera);
}

std::vector<JointValue> joint_values(const RoverParameters& rover, const RoverState& state) {
  std::vector<JointValue> joints;
  const int wheels = wheel_count(rover.suspension);
  constexpr std::size_t rockers_and_bogies = 4;
  joints.reserve(rockers_and_bogies + 2 * static_cast<std::size_t>(wheels));
  for (int side = 0; side < 2; ++side)
    joints.push_back({"rocker" + side_name(side) + "_joint", side == 0 ? state.rocker : -state.rocker, 0});
  for (int side = 0; side < 2 && wheels == 6; ++side)
    joints.push_back({"bogie" + side_name(side) + "_joint", state.bogie[static_cast<std::size_t>(side)], 0});
  for (int n = 0; n < wheels; ++n) {
    const WheelState& w = state.wheels[static_cast<std::size_t>(n)];
    if (rover.steering != Steering::skid)
      joints.push_back({wheel_name(n, wheels) + "_steer_joint", w.steer, 0});
    joints.push_back({wheel_name(n, wheels) + "_wheel_joint", w.angle, w.rim_speed / rover.wheel_radius});
  }
  return joints;
}

}  // namespace desert_sim
