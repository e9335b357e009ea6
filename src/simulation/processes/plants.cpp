/// The processes of plants: what they cover, what light they leave, and how they live.
#include "kernels/plants/cover.hpp"
#include "kernels/plants/illumination.hpp"
#include "kernels/plants/life.hpp"
#include "src/simulation/processes/processes.hpp"

namespace desert_sim {

namespace {

/// `makes_state`: also vegetation and humus, which a look at the terrain must leave alone.
void cover_ground(StepContext& c, bool makes_state) {
  with_backend(c.exec(), [&](auto& e) {
    plants::cover(e, c.terrain, c.scenario().vegetation, makes_state ? c.time_step() : 0.0f, c.dice(),
                  c.fields.heights, makes_state, c.state.plants);
  });
}

void illuminate(StepContext& c, ProcessWorkspace*) {
  with_backend(c.exec(), [&](auto& e) {
    plants::illuminate(e, c.terrain, c.scenario().vegetation, c.fields.heights, c.state.plants);
  });
}

void update_plants(StepContext& c, ProcessWorkspace*) {
  const Scenario& s = c.scenario();
  with_backend(c.exec(), [&](auto& e) {
    plants::grow_and_spawn(e, c.terrain, s.vegetation, s.repose, c.fields.heights, c.time_step(), s.seed,
                           c.tick(), c.dice(), c.state.ledger(), c.state.plants);
  });
}

bool has_plants(const Scenario& s) { return s.vegetation.enabled; }

}  // namespace

Process plant_cover_process() {
  Process p;
  p.name = "plant_cover";
  p.parameters = {"vegetation", "species"};
  p.source = "Nilles 2025 §3.2.1, eq. 8–12";
  p.header = "kernels/plants/cover.hpp";
  p.active = has_plants;
  p.reads_heights = true;
  p.reads = {Layer::bedrock, Layer::soil, Layer::sand, Layer::wind_x, Layer::wind_y};
  p.writes = {Layer::vegetation, Layer::humus, Layer::canopy_height};
  p.step = [](StepContext& c, ProcessWorkspace*) { cover_ground(c, true); };
  p.refresh = [](StepContext& c, ProcessWorkspace*) { cover_ground(c, false); };
  return p;
}

Process illumination_process() {
  Process p;
  p.name = "illumination";
  p.parameters = {"vegetation"};
  p.source = "Nilles 2025 §3.2.3, eq. 16–18";
  p.header = "kernels/plants/illumination.hpp";
  p.active = has_plants;
  p.reads_heights = true;
  p.reads = {Layer::bedrock, Layer::soil, Layer::sand, Layer::canopy_height, Layer::water};
  p.writes = {Layer::illumination, Layer::illumination_canopy};
  p.step = p.refresh = illuminate;
  return p;
}

Process vegetation_process() {
  Process p;
  p.name = "vegetation";
  p.parameters = {"vegetation", "species", "competition", "repose"};
  p.source = "Nilles 2025 §3.2.2–3.2.6, eq. 13–24";
  p.header = "kernels/plants/life.hpp";
  p.active = has_plants;
  p.reads_heights = true;
  p.reads = {Layer::bedrock,  Layer::soil,          Layer::sand,         Layer::water,
             Layer::obstacle, Layer::canopy_height, Layer::illumination, Layer::illumination_canopy};
  p.writes = {Layer::humus};
  p.writes_if_in_use = {Layer::moisture};
  p.step = update_plants;
  // Plants grow into each other's way and light within seconds.
  p.longest_step = [](const SimulationState&) { return 1.0f; };
  // New plants come up by dice that depend on the step, and their number is read back.
  p.can_be_recorded = [](const SimulationState&) { return false; };
  return p;
}

}  // namespace desert_sim
