#pragma once
/// The table of all processes, in the order of a step. A new one is a function here that returns its row, and
/// a line in process_table().

#include "src/scenario/sand_model.hpp"
#include "src/simulation/pipeline/pipeline.hpp"

namespace desert_sim {

Process wind_process();  // wind.cpp
Process shear_stress_process();
Process wind_shadow_process();
Process echo_dune_process();

Process sand_flux_process();  // sand.cpp
Process saltation_process();
Process repose_process();
Process reptation_process();
Process avalanching_process();
Process sand_overflow_process();
FusedProcesses fused_wind_shadow_and_saltation();

Process desertscape_process();  // desertscape.cpp

Process continuum_process();  // continuum.cpp

Process werner_process();  // slabs.cpp
Process momiji_process();
Process bishop_process();
Process nield_baas_process();
Process snow_process();

Process wang_process();  // particles.cpp

Process sand_record_process();  // looseness.cpp
Process looseness_process();
Process slide_looseness_process();

Process rain_process();  // water.cpp
Process virtual_pipes_process();
Process shallow_water_process();
Process hydraulic_erosion_process();
Process moisture_process();
Process evaporation_process();
Process soil_process();

Process plant_cover_process();  // plants.cpp
Process illumination_process();
Process vegetation_process();

const ProcessTable& process_table();

/// Whether this model moves the sand.
bool has_sand_model(const Scenario& scenario, SandModel model);
/// Whether water is simulated: it is enabled, or rain, springs, hydraulic erosion or moisture need it.
bool has_water(const Scenario& scenario);
/// Throws ConfigError, in the name of `what`, if the sea is higher than the scale can represent. One that is
/// lower is no sea, whatever its level.
void require_sea(const Scenario& scenario, const HeightScale& scale, const std::string& what);

/// Of Pipeline::count(): fine sweeps of avalanching.
constexpr const char* avalanche_iterations = "avalanche_iterations";

/// What the wind is blocked by: the ground, or the plants' canopy.
const surface::Heights& obstructing_heights(const StepContext& context);
/// Whether something but edits changes rock or soil.
bool wears_ground(const Scenario& scenario);
/// The page config/processes.md: `desert_run --describe-processes`.
std::string describe_processes(const ProcessTable& table);
/// The steps of one scenario: `desert_run SCENARIO.yaml --pipeline`.
std::string describe_pipeline(const Pipeline& pipeline);

}  // namespace desert_sim
