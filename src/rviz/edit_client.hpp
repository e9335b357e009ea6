#pragma once
/// Sends edits to a node on a thread of its own, so that nobody waits for the node. One call is under way
/// at a time, and at most so many a second; what is painted meanwhile grows the path of its stroke, of
/// which the next call takes one capsule (render::StrokePath). What a brush paints later (Brush::later) is
/// sent when its stroke has ended: entries of run.timeline, one for each straight part.

#include <desert_sim/QueryTerrain.h>
#include <ros/service_client.h>

#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "src/rviz/brush.hpp"

namespace desert_sim {

class EditClient {
 public:
  static constexpr int shortest_pause_ms = 20;  ///< between the beginnings of two calls [ms]

  /// `node`: the node's name, such as /desert_sim.
  explicit EditClient(const std::string& node);
  /// Gives up what is not sent yet, and a call that is under way.
  ~EditClient();
  EditClient(const EditClient&) = delete;
  EditClient& operator=(const EditClient&) = delete;

  // ---- Painting. All return at once; places are in the terrain's frame.

  /// Begins a stroke, which ends the one before. Nothing is painted before the first place.
  void begin(const Brush& brush);
  void move(const render::Place& place);
  /// The brush has left the ground, but the stroke goes on.
  void lift();
  void end();

  /// ~undo and ~redo without a name, after all that was painted before. They end a stroke that has not ended.
  void undo();
  void redo();

  // ---- What has become of it.

  struct Report {
    bool success = false;
    std::string text;  ///< what was done, or why not; one line
  };
  /// The newest report since the last call. The first failure of a stroke stands until the next stroke
  /// succeeds.
  std::optional<Report> take_report();
  /// Whether everything is done.
  bool idle() const;
  /// The calls made since the start.
  std::uint64_t calls() const;

 private:
  struct Stroke {
    Brush brush;
    render::StrokePath path;
    std::string name;
    bool failed = false;
    double volume = 0;  ///< [m³] so far
    std::int64_t plants = 0;
    std::optional<double> level = std::nullopt;  ///< for flatten: known from the first call on
    std::vector<render::Capsule> later{};        ///< what is still to be put into the timeline
  };
  struct Job {
    std::optional<Stroke> stroke;  ///< else undo or redo
    bool redo = false;
  };

  void turn(bool redo);
  void run();
  void paint(Stroke& stroke, const render::Capsule& capsule);
  void put_into_timeline(Stroke& stroke);
  QueryTerrain::Response sample(const render::Place& place);
  void call_turn(bool redo);
  template <class Service>
  typename Service::Response call(const char* name, const typename Service::Request& request);
  void report(bool success, const std::string& text);

  const std::string node_;
  std::uint64_t strokes_ = 0;  ///< begun so far; used by one thread only

  mutable std::mutex mutex_;  ///< protects all that follows; held only briefly
  std::condition_variable changed_;
  std::deque<Job> jobs_;  ///< the thread works on the first one; strokes stay until their path is finished
  ros::ServiceClient under_way_;
  std::optional<Report> report_;
  std::uint64_t calls_ = 0;
  bool stopping_ = false;
  std::thread thread_;  ///< the last member: it uses the others
};

}  // namespace desert_sim
