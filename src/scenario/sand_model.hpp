#pragma once
/// Which model moves the sand: one at a time.

#include "src/core/parameter_table.hpp"

namespace desert_sim {

enum class SandModel : int {
  hops,
  continuum,
  desertscape_2019,
  werner,
  momiji,
  bishop,
  nield_baas,
  snow,
  wang
};
constexpr const char* sand_model_names[] = {
    "hops", "continuum", "desertscape_2019", "werner", "momiji", "bishop", "nield_baas", "snow", "wang"};
constexpr const char* name_of(SandModel model) { return sand_model_names[static_cast<int>(model)]; }

/// Whether the section `saltation` says if it moves sand at all.
constexpr bool is_saltation(SandModel model) {
  return model == SandModel::hops || model == SandModel::continuum || model == SandModel::desertscape_2019;
}

/// Whether it moves slabs on a lattice: those of slab_model.
constexpr bool is_slab_model(SandModel model) {
  return model == SandModel::werner || model == SandModel::momiji || model == SandModel::bishop ||
         model == SandModel::nield_baas || model == SandModel::snow;
}

struct SandParameters {
  SandModel model = SandModel::hops;
};

constexpr auto parameter_table(const SandParameters*) {
  return std::make_tuple(parameter(
      "model", &SandParameters::model, sand_model_names,
      "What moves the sand. hops: a share of it a second, in hops (section saltation); desertscape_2019: the "
      "same as random events of slabs (sections saltation, desertscape_2019); continuum: in real units "
      "(sections shear_stress, continuum; of saltation influx and flux). werner, momiji, bishop, nield_baas, "
      "snow: slabs on a lattice (sections slab_model, slab_plants, slab_snow), in place of wind, reptation "
      "and avalanching. wang: flights of grains (section particle), in place of wind and reptation."));
}
static_assert(table_is_complete<SandParameters>());

}  // namespace desert_sim
