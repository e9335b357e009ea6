// A plugin for worlds of Gazebo 11: prints how high the ground is at the points of the file DESERT_POINTS, by
// a ray from above to what bodies collide with. Each line of the file has x, y and about how high it is [m].
#include <cstdlib>
#include <fstream>
#include <gazebo/gazebo.hh>
#include <gazebo/physics/physics.hh>
#include <iomanip>
#include <iostream>

namespace {

class GroundProbe : public gazebo::WorldPlugin {
 public:
  void Load(gazebo::physics::WorldPtr world, sdf::ElementPtr) override {
    world_ = world;
    update_ = gazebo::event::Events::ConnectWorldUpdateBegin(
        [this](const gazebo::common::UpdateInfo&) { update(); });
  }

 private:
  void update() {
    update_.reset();
    const gazebo::physics::PhysicsEnginePtr engine = world_->Physics();
    engine->InitForThread();
    const auto ray = boost::dynamic_pointer_cast<gazebo::physics::RayShape>(
        engine->CreateShape("ray", gazebo::physics::CollisionPtr()));
    const char* const file = std::getenv("DESERT_POINTS");
    std::ifstream points(file ? file : "");
    for (double x, y, z; points >> x >> y >> z;) {
      constexpr double reach = 20;  // [m]: rays of kilometres miss heightmaps
      double distance = 0;
      std::string hit;
      ray->SetPoints({x, y, z + reach}, {x, y, z - reach});
      ray->GetIntersection(distance, hit);
      std::cout << "GROUND " << std::setprecision(12) << x << " " << y << " " << z + reach - distance << " "
                << (hit.empty() ? "none" : hit) << std::endl;
    }
    std::cout << "GROUND end" << std::endl;
  }

  gazebo::physics::WorldPtr world_;
  gazebo::event::ConnectionPtr update_;
};

}  // namespace

GZ_REGISTER_WORLD_PLUGIN(GroundProbe)
