#include "src/ros/conversion/messages.hpp"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cinttypes>
#include <cstdio>

namespace desert_sim {

namespace {

const char* state_text(RunState state) {
  switch (state) {
    case RunState::running:
      return SimulationStatus::RUNNING.c_str();
    case RunState::paused:
      return SimulationStatus::PAUSED.c_str();
    case RunState::waiting:
      return SimulationStatus::WAITING.c_str();
  }
  throw Error("unknown state");
}

/// Means of blocks; a layer that is not in use is 0.
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

}  // namespace

std_msgs::Header header_of(const Moment& moment, const std::string& frame) {
  std_msgs::Header header;
  header.stamp = moment.stamp;
  header.frame_id = frame;
  return header;
}

geometry_msgs::Pose origin_of(const Snapshot& snapshot) {
  geometry_msgs::Pose pose;
  pose.position.x = snapshot.origin_x;
  pose.position.y = snapshot.origin_y;
  pose.orientation.w = 1;
  return pose;
}

geometry_msgs::Vector3 vector_of(wind::Vector v) {
  geometry_msgs::Vector3 vector;
  vector.x = v.x;
  vector.y = v.y;
  return vector;
}

std::string hash_text(std::uint64_t hash) {
  char text[20];
  std::snprintf(text, sizeof text, "%016" PRIx64, hash);
  return text;
}

ElevationGridPtr elevation_message(const TerrainState& state, const std::string& frame,
                                   std::uint32_t keyframe) {
  const Snapshot& s = *state.snapshot;
  ElevationGridPtr message = boost::make_shared<ElevationGrid>();
  message->header = header_of(state.moment, frame);
  message->step = s.step;
  message->sim_time = s.time;
  message->keyframe = keyframe;
  message->width = static_cast<std::uint32_t>(s.width);
  message->height = static_cast<std::uint32_t>(s.height);
  message->cell_size = s.cell_size;
  message->origin = origin_of(s);
  message->elevation = s.layers.at(Layer::elevation);
  return message;
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

TerrainDiffPtr diff_message(const Reached& edit, const std::string& frame) {
  const CellRectangle& touched = edit.result.touched;
  const LayerChange& change = edit.result.change;
  TerrainDiffPtr message = boost::make_shared<TerrainDiff>();
  message->header = header_of(edit.moment, frame);
  message->step = edit.moment.step;
  message->layer = change.layer;
  message->cell_size = change.cell_size;
  message->origin.position.x = change.x;
  message->origin.position.y = change.y;
  message->origin.orientation.w = 1;
  message->x = static_cast<std::uint32_t>(touched.x0);
  message->y = static_cast<std::uint32_t>(touched.y0);
  message->width = static_cast<std::uint32_t>(touched.x1 - touched.x0);
  message->height = static_cast<std::uint32_t>(touched.y1 - touched.y0);
  message->change = change.values;
  return message;
}

SimulationStatusPtr status_message(const StatusReport& report, const std::string& frame) {
  SimulationStatusPtr message = boost::make_shared<SimulationStatus>();
  message->header = header_of(report.moment, frame);
  message->state = state_text(report.state);
  message->message = report.backend_choice;
  message->scenario = report.scenario;
  message->backend = report.backend;
  message->device = report.device;
  message->step = report.moment.step;
  message->sim_time = report.moment.time;
  message->step_rate = report.step_rate;
  message->steps_per_second = report.steps_per_second;
  message->lag = report.lag;
  for (const ProcessTime& time : report.process_times) {
    ProcessTiming row;
    row.process = time.process;
    row.milliseconds = time.milliseconds;
    message->process_times.push_back(row);
  }
  for (int m = 0; m < material_count; ++m) {
    const MaterialBalance& b = report.balance[static_cast<std::size_t>(m)];
    if (b.initial == 0 && b.final == 0 && b.in == 0 && b.out == 0) continue;
    MaterialVolume row;
    row.material = material_names[m];
    row.initial = b.cubic_metres(b.initial);
    row.final = b.cubic_metres(b.final);
    row.entered = b.cubic_metres(b.in);
    row.left = b.cubic_metres(b.out);
    row.residual = b.relative_residual();
    message->volumes.push_back(row);
  }
  message->changes = report.changes;
  message->wind_above = vector_of(report.wind_above);
  if (report.hashed) message->state_hash = hash_text(report.hash);
  message->snapshots = report.snapshots;
  return message;
}

}  // namespace desert_sim
