/// Services that edit terrain and plants, and take edits back. What each changed is told on ~terrain_diff.

#include <desert_sim/EditPlants.h>
#include <desert_sim/EditTerrain.h>
#include <desert_sim/TerrainDiff.h>
#include <desert_sim/Undo.h>

#include <boost/make_shared.hpp>

#include "src/ros/conversion/messages.hpp"
#include "src/ros/services/requests.hpp"
#include "src/ros/services/services.hpp"

namespace desert_sim {

namespace {

template <class Message>
void set_rectangle(const CellRectangle& cells, Message& message) {
  message.x = static_cast<std::uint32_t>(cells.x0);
  message.y = static_cast<std::uint32_t>(cells.y0);
  message.width = static_cast<std::uint32_t>(cells.x1 - cells.x0);
  message.height = static_cast<std::uint32_t>(cells.y1 - cells.y0);
}

/// What a command that was asked for with its change has changed in one layer.
TerrainDiffPtr diff_message(const ReachedState& edit, const LayerChange& change, const std::string& frame) {
  const CellRectangle& touched = edit.result.changed_cells;
  TerrainDiffPtr message = boost::make_shared<TerrainDiff>();
  message->header = header_of(edit.moment, frame);
  message->step = edit.moment.step;
  message->layer = change.layer;
  message->cell_size = change.cell_size;
  message->origin.position.x = change.x;
  message->origin.position.y = change.y;
  message->origin.orientation.w = 1;
  message->change = change.values;
  set_rectangle(touched, *message);
  return message;
}

/// Applies a command that changes cells, and tells the subscribers of ~terrain_diff.
ReachedState apply_and_tell(const ServiceContext& c, const ros::Publisher& terrain_diff,
                            const Command& command) {
  const bool diff = terrain_diff.getNumSubscribers() > 0;
  ReachedState reached = c.simulation.apply(command, false, diff).get();
  for (const LayerChange& change : reached.result.changes)
    terrain_diff.publish(diff_message(reached, change, c.frames.terrain_frame()));
  c.publisher.status_changed();
  return reached;
}

void set_returned(const ReachedState& reached, UndoResponse& response) {
  const CommandResult& result = reached.result;
  response.stroke = result.returned.name;
  for (std::size_t m = 0; m < result.returned.materials.size(); ++m) {
    const auto& volumes = result.returned.materials[m];
    if (!volumes) continue;
    ReturnedMaterial material;
    material.material = material_names[m];
    material.added = volumes->added_m3;
    material.removed = volumes->removed_m3;
    material.missing = volumes->missing_m3;
    response.materials.push_back(material);
  }
  response.plants = result.plants;
  response.missing_plants = result.returned.missing_plants;
  response.settings = result.returned.settings;
  response.terrain_replaced = result.replaces_terrain;
  set_rectangle(result.changed_cells, response);
  response.step = reached.moment.step;
  response.undoable = static_cast<std::uint32_t>(result.undoable);
  response.redoable = static_cast<std::uint32_t>(result.redoable);
}

}  // namespace

void add_edit_services(Services& services) {
  const ServiceContext& c = services.context();
  const ros::Publisher terrain_diff = ros::NodeHandle(c.node).advertise<TerrainDiff>("terrain_diff", 100);

  services.add<EditTerrain>("edit_terrain", [&c, terrain_diff](const EditTerrainRequest& request,
                                                               EditTerrainResponse& response) {
    const ReachedState reached = apply_and_tell(c, terrain_diff, edit_command(request, c.frames, c.files));
    response.volume = reached.result.volume_m3;
    response.moved = reached.result.moved_m3;
    set_rectangle(reached.result.changed_cells, response);
    response.step = reached.moment.step;
  });
  services.add<EditPlants>(
      "edit_plants", [&c](const EditPlantsRequest& request, EditPlantsResponse& response) {
        const ReachedState reached = c.simulation.apply(plants_command(request, c.frames)).get();
        response.plants = reached.result.plants;
        response.step = reached.moment.step;
        c.publisher.status_changed();
      });
  const auto turn = [&services, &c, terrain_diff](const Command& command, UndoResponse& response) {
    const ReachedState reached = apply_and_tell(c, terrain_diff, command);
    if (reached.result.replaces_terrain) services.terrain_replaced();
    set_returned(reached, response);
  };
  services.add<Undo>("undo", [turn](const UndoRequest& request, UndoResponse& response) {
    turn(command::Undo{request.stroke}, response);
  });
  services.add<Undo>("redo", [turn](const UndoRequest& request, UndoResponse& response) {
    turn(command::Redo{request.stroke}, response);
  });
}

}  // namespace desert_sim
