/// The processes of plants: what they cover, what light they leave, and how they live.
#include "kernels/plants/cover.hpp"
#include "kernels/plants/illumination.hpp"
#include "kernels/plants/life.hpp"
#include "kernels/slabs/slab_model.hpp"
#include "src/core/number_text.hpp"
#include "src/simulation/processes/processes.hpp"

namespace desert_sim {

namespace {

/// The look-up of neighbours does not find wider ones.
void check_radii(const Scenario& s, ValidationErrors& errors) {
  const float largest = s.get<VegetationParameters>().largest_plant;
  for (std::size_t n = 0; n < s.species.size(); ++n)
    if (const float radius = s.species[n].traits.max_radius; radius > largest)
      errors.add(
          "species." + std::to_string(n) + ".max_radius",
          number_text(radius) + " m is more than vegetation.largest_plant, " + number_text(largest) + " m");
}

void check_plants(const Scenario& s, ValidationErrors& errors) {
  check_radii(s, errors);
  if (!s.get<VegetationParameters>().enabled) return;
  if (s.species.empty()) errors.add("vegetation.enabled", "needs at least one entry in species");
  for (std::size_t n = 0; n < s.terrain.size(); ++n)
    std::visit(
        [&](const auto& step) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(step)>, ObstacleStep>)
            if (step.layer == info(Layer::vegetation).name)
              errors.add(
                  "terrain." + std::to_string(n) + "." + terrain_step_names[s.terrain[n].index()] + ".layer",
                  "vegetation cannot be set while vegetation.enabled is true: the plants determine it");
        },
        s.terrain[n]);
}

const std::string section = register_section<VegetationParameters>("vegetation", check_plants);

/// Where slabs or grains are moved, the process that moves them makes the wind, and comes after the plants:
/// what they would find is the wind of the step before, or, after a checkpoint, none.
void blow_before_sand_moves(StepContext& c) {
  const SandModel model = c.scenario().get<SandParameters>().model;
  if (is_saltation(model) || !has_sand_model(c.scenario(), model)) return;
  with_backend(c.exec(), [&](auto& e) { slabs::blow(e, c.terrain, c.wind_above()); });
}

/// `makes_state`: also vegetation and humus, which a look at the terrain must leave alone.
void cover_ground(StepContext& c, bool makes_state) {
  blow_before_sand_moves(c);
  with_backend(c.exec(), [&](auto& e) {
    plants::cover(e, c.terrain, c.scenario().get<VegetationParameters>(),
                  {makes_state ? c.time_step() : 0.0f, c.fields.heights, makes_state}, c.dice(),
                  c.state.plants);
  });
}

void illuminate(StepContext& c, ProcessWorkspace*) {
  with_backend(c.exec(), [&](auto& e) {
    plants::illuminate(e, c.terrain, c.scenario().get<VegetationParameters>(), c.fields.heights,
                       c.state.plants);
  });
}

void update_plants(StepContext& c, ProcessWorkspace*) {
  const Scenario& s = c.scenario();
  with_backend(c.exec(), [&](auto& e) {
    const plants::StepInputs in{s.get<VegetationParameters>(),
                                s.get<ReposeParameters>(),
                                c.fields.heights,
                                c.time_step(),
                                s.seed,
                                c.tick()};
    plants::grow_and_spawn(e, c.terrain, in, c.dice(), c.state.ledger(), c.state.plants);
  });
}

/// Longest part of a step in which plants live [s]: they grow into each other's way and light within seconds.
/// No parameter: run.time_step makes parts shorter.
constexpr float longest_life = 1.0f;

bool has_plants(const Scenario& s) { return s.get<VegetationParameters>().enabled; }

}  // namespace

Process plant_cover_process() {
  Process p;
  p.name = "plant_cover";
  p.parameters = {section, "species"};
  p.source = "Nilles 2025 §3.2.1, eq. 8–12";
  p.header = "kernels/plants/cover.hpp";
  p.active = has_plants;
  p.reads_heights = true;
  p.reads = {Layer::bedrock, Layer::soil, Layer::sand, Layer::wind_x, Layer::wind_y};
  p.writes = {Layer::vegetation, Layer::humus, Layer::canopy_height};
  p.writes_if_in_use = {Layer::wind_x, Layer::wind_y};
  p.step = [](StepContext& c, ProcessWorkspace*) { cover_ground(c, true); };
  p.refresh = [](StepContext& c, ProcessWorkspace*) { cover_ground(c, false); };
  return p;
}

Process illumination_process() {
  Process p;
  p.name = "illumination";
  p.parameters = {section};
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
  p.parameters = {section, "species", "competition", "repose"};
  p.source = "Nilles 2025 §3.2.2–3.2.6, eq. 13–24";
  p.header = "kernels/plants/life.hpp";
  p.active = has_plants;
  p.reads_heights = true;
  p.reads = {Layer::bedrock,  Layer::soil,          Layer::sand,         Layer::water,
             Layer::obstacle, Layer::canopy_height, Layer::illumination, Layer::illumination_canopy};
  p.writes = {Layer::humus};
  p.writes_if_in_use = {Layer::moisture};
  p.step = update_plants;
  p.longest_step = [](const SimulationState&) { return longest_life; };
  // New plants come up by dice that depend on the step, and their number is read back.
  p.can_be_recorded = [](const SimulationState&) { return false; };
  return p;
}

}  // namespace desert_sim
