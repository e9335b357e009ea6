#include "src/rviz/edit_client.hpp"

#include <desert_sim/QueryTerrain.h>
#include <desert_sim/Undo.h>
#include <ros/node_handle.h>
#include <ros/this_node.h>

#include <chrono>
#include <iomanip>
#include <sstream>

#include "src/core/error.hpp"
#include "src/rviz/names.hpp"
#include "src/rviz/undo_text.hpp"

namespace desert_sim {

namespace {

using Clock = std::chrono::steady_clock;

/// Pieces of half a radius overlap to an even depth: longer ones would leave heaps where they meet.
constexpr double piece = 0.5, tolerance = 0.125;  // of the radius

std::string number(double value) {
  std::ostringstream text;
  text << std::setprecision(3) << std::showpos << value;
  return text.str();
}

/// No other stroke of any program has this name.
std::string unique_name(std::uint64_t count) {
  std::ostringstream text;
  text << ros::this_node::getName() << ' ' << std::fixed << std::setprecision(3)
       << ros::WallTime::now().toSec() << ' ' << count;
  return text.str();
}

}  // namespace

EditClient::EditClient(const std::string& node) : node_(node), thread_([this] { run(); }) {}

EditClient::~EditClient() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
    under_way_.shutdown();  // the call returns, even if the node does not answer
  }
  changed_.notify_all();
  thread_.join();
}

// ---- any thread ----

void EditClient::begin(const Brush& brush) {
  end();
  const std::lock_guard<std::mutex> lock(mutex_);
  Job job;
  job.stroke.emplace(
      Stroke{brush, {piece * brush.radius, tolerance * brush.radius}, unique_name(++strokes_)});
  jobs_.push_back(std::move(job));
}

void EditClient::move(const render::Place& place) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (jobs_.empty() || !jobs_.back().stroke) return;
    jobs_.back().stroke->path.add(place);
  }
  changed_.notify_all();
}

void EditClient::lift() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!jobs_.empty() && jobs_.back().stroke) jobs_.back().stroke->path.lift();
  }
  changed_.notify_all();
}

void EditClient::end() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!jobs_.empty() && jobs_.back().stroke) jobs_.back().stroke->path.end();
  }
  changed_.notify_all();
}

void EditClient::undo() { turn(false); }
void EditClient::redo() { turn(true); }

void EditClient::turn(bool redo) {
  end();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    Job job;
    job.redo = redo;
    jobs_.push_back(std::move(job));
  }
  changed_.notify_all();
}

std::optional<EditClient::Report> EditClient::take_report() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(report_, std::nullopt);
}

bool EditClient::idle() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return jobs_.empty();
}

std::uint64_t EditClient::calls() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return calls_;
}

// ---- the thread ----

void EditClient::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  Clock::time_point next{};
  while (!stopping_) {
    if (jobs_.empty()) {
      changed_.wait(lock);
      continue;
    }
    if (changed_.wait_until(lock, next, [this] { return stopping_; })) break;
    Job& job = jobs_.front();  // stays where it is: a deque moves nothing when others are appended
    std::optional<render::Capsule> capsule;
    if (job.stroke) {
      capsule = job.stroke->path.take();
      if (!capsule) {
        if (job.stroke->path.finished())
          jobs_.pop_front();
        else
          changed_.wait(lock);
        continue;
      }
    }
    next = Clock::now() + std::chrono::milliseconds(shortest_pause_ms);
    lock.unlock();
    if (job.stroke)
      paint(*job.stroke, *capsule);
    else
      call_turn(job.redo);
    lock.lock();
    if (!job.stroke) jobs_.pop_front();
  }
}

template <class Service>
typename Service::Response EditClient::call(const char* name, const typename Service::Request& request) {
  const std::string service = full_name(node_, "node") + "/" + name;
  ros::NodeHandle node;
  ros::ServiceClient client =
      node.serviceClient<Service>(service, true);  // one that can be shut down while it waits
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (stopping_) throw ConfigError("rviz is closing");
    under_way_ = client;
    ++calls_;
  }
  if (!client.isValid())
    throw ConfigError("There is no service " + service + ": start the node, or change the tool's Node.");
  Service exchange;
  exchange.request = request;
  if (!client.call(exchange))
    throw ConfigError("The node ended before it answered a call of " + service + ".");
  if (!exchange.response.success) throw ConfigError(exchange.response.message);
  return exchange.response;
}

/// The value of the brush's layer [m].
double EditClient::level_at(const Stroke& stroke, const render::Place& place) {
  QueryTerrain::Request request;
  request.points.resize(1);
  request.points[0].x = place.x;
  request.points[0].y = place.y;
  const QueryTerrain::Response answer = call<QueryTerrain>("query_terrain", request);
  const TerrainSample& sample = answer.samples.at(0);
  if (!sample.in_bounds) throw ConfigError("The stroke begins outside the terrain.");
  switch (stroke.brush.material) {
    case Brush::Material::bedrock:
      return sample.bedrock;
    case Brush::Material::soil:
      return sample.soil;
    case Brush::Material::water:
      return sample.water;
    case Brush::Material::moisture:
      return sample.moisture;
    case Brush::Material::vegetation:
      return sample.vegetation;
    default:
      return sample.sand;
  }
}

void EditClient::paint(Stroke& stroke, const render::Capsule& capsule) {
  const Brush& brush = stroke.brush;
  const std::string layer = layer_of(brush.material);
  try {
    if (brush.operation == Brush::Operation::flatten && !stroke.level)
      stroke.level = level_at(stroke, capsule.from);
    if (brush.material == Brush::Material::plants) {
      const std::uint64_t seed = std::hash<std::string>()(stroke.name) + calls();
      stroke.plants +=
          call<EditPlants>("edit_plants", plants_request(brush, capsule, stroke.name, seed)).plants;
    } else {
      const EditTerrain::Request request =
          terrain_request(brush, capsule, stroke.name, stroke.level.value_or(0));
      stroke.volume += call<EditTerrain>("edit_terrain", request).volume;
    }
    if (stroke.failed) return;
    if (brush.material == Brush::Material::plants)
      report(true, number(static_cast<double>(stroke.plants)) + " plants");
    else
      report(true, layer + (!is_material(brush.material) ? "" : " " + number(stroke.volume) + " m³"));
  } catch (const ConfigError& error) {
    if (!stroke.failed) report(false, error.what());
    stroke.failed = true;
  }
}

void EditClient::call_turn(bool redo) {
  try {
    const Undo::Response answer = call<Undo>(redo ? "redo" : "undo", {});
    const std::string what = turn_text(answer);
    report(true, (redo ? "Redone" : "Undone") + (what.empty() ? "" : ", " + what) + "; " +
                     std::to_string(answer.undoable) + " can be undone, " + std::to_string(answer.redoable) +
                     " redone");
  } catch (const ConfigError& error) {
    report(false, error.what());
  }
}

void EditClient::report(bool success, const std::string& text) {
  const std::lock_guard<std::mutex> lock(mutex_);
  report_ = Report{success, text};
}

}  // namespace desert_sim
