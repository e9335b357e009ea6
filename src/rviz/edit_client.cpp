#include "src/rviz/edit_client.hpp"

#include <desert_sim/ApplySettings.h>
#include <desert_sim/GetScenario.h>
#include <desert_sim/Undo.h>
#include <ros/node_handle.h>
#include <ros/this_node.h>

#include <chrono>
#include <iomanip>
#include <limits>
#include <sstream>

#include "src/core/error.hpp"
#include "src/rviz/brush_entries.hpp"
#include "src/rviz/names.hpp"
#include "src/rviz/settings_news.hpp"
#include "src/rviz/timeline_entries.hpp"
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

/// The value of a material at a sample [m].
double depth_of(Brush::Material material, const TerrainSample& sample) {
  switch (material) {
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
  const double length = brush.later ? std::numeric_limits<double>::infinity() : piece * brush.radius;
  job.stroke.emplace(Stroke{brush, {length, tolerance * brush.radius}, unique_name(++strokes_)});
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
      if (capsule && job.stroke->brush.later) {
        job.stroke->later.push_back(*capsule);
        continue;
      }
      if (!capsule && !job.stroke->path.finished()) {
        changed_.wait(lock);
        continue;
      }
      if (!capsule && job.stroke->later.empty()) {
        jobs_.pop_front();
        continue;
      }
    }
    next = Clock::now() + std::chrono::milliseconds(shortest_pause_ms);
    lock.unlock();
    if (capsule)
      paint(*job.stroke, *capsule);
    else if (job.stroke)
      put_into_timeline(*job.stroke);
    else
      call_turn(job.redo);
    lock.lock();
    if (!capsule) jobs_.pop_front();
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

/// The terrain where a stroke begins.
QueryTerrain::Response EditClient::sample(const render::Place& place) {
  QueryTerrain::Request request;
  request.points.resize(1);
  request.points[0].x = place.x;
  request.points[0].y = place.y;
  QueryTerrain::Response answer = call<QueryTerrain>("query_terrain", request);
  if (!answer.samples.at(0).in_bounds) throw ConfigError("The stroke begins outside the terrain.");
  return answer;
}

void EditClient::paint(Stroke& stroke, const render::Capsule& capsule) {
  const Brush& brush = stroke.brush;
  const std::string layer = layer_of(brush.material);
  try {
    if (brush.operation == Brush::Operation::flatten && !stroke.level)
      stroke.level = depth_of(brush.material, sample(capsule.from).samples[0]);
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

void EditClient::put_into_timeline(Stroke& stroke) {
  const Brush& brush = stroke.brush;
  try {
    const QueryTerrain::Response now = sample(stroke.later.front().from);
    const double level = depth_of(brush.material, now.samples[0]);
    TimelineEntries entries = timeline_entries(call<GetScenario>("get_scenario", {}).yaml);
    const bool alone = stroke.later.size() == 1;
    std::string entry;
    std::uint64_t seed = std::hash<std::string>()(stroke.name) % 1'000'000;
    for (const render::Capsule& capsule : stroke.later) {
      entry =
          brush.material == Brush::Material::plants
              ? timeline_entry(*brush.later, now.sim_time, plants_request(brush, capsule, "", ++seed, alone))
              : timeline_entry(*brush.later, now.sim_time, terrain_request(brush, capsule, "", level, alone));
      insert_entry(entries, entry);
    }
    ApplySettings::Request request;
    request.settings = {timeline_setting(entries)};
    call<ApplySettings>("apply_settings", request);
    SettingsNews::tell(full_name(node_, "node"));
    report(true, "timeline: " + words_of(entry).when + ", " + layer_of(brush.material));
  } catch (const ConfigError& error) {
    report(false, error.what());
  }
}

void EditClient::call_turn(bool redo) {
  try {
    const Undo::Response answer = call<Undo>(redo ? "redo" : "undo", {});
    const std::string what = turn_text(answer);
    if (changes_settings(answer)) SettingsNews::tell(full_name(node_, "node"));
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
