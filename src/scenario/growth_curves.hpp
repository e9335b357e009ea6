#pragma once
/// The key `growth_curves` of a scenario: how the plants of the slab model nield_baas grow. Kinds that it
/// does not give have the curves of config/growth_curves/nield_baas.yaml.

#include "kernels/slabs/growth_curves.hpp"

namespace YAML {
class Node;
class Emitter;
}  // namespace YAML

namespace desert_sim {

class ValidationErrors;

constexpr double most_burial = 100, most_growth = 10;  ///< of points, either sign [m/year, 1/year]

/// Reads the key. A curve that is refused adds an error and keeps its default.
GrowthCurves read_growth_curves(const YAML::Node& root, ValidationErrors& errors);
/// Writes it as an entry of an open map.
void emit_growth_curves(YAML::Emitter& out, const GrowthCurves& curves);

}  // namespace desert_sim
