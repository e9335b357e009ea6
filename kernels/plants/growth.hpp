#pragma once
/// Growth, health and death of plants. Nilles 2025 §3.2.4–3.2.5, eq. 19–27.
///
///   radius   r      += Δt φ_g Π g
///   health   health += Δt (φ_g Π g − φ_d Σ d),   at most 1
///
/// The growth factors g of plant k are
///
///   competition   1 − Σ_j ¼ D_kj (min(|x_j − x_k| − (r_k + r_j), 0)/r_k)²
///   light         1 in the middle of the species' interval, 0 at its ends; light at the top of the stem
///   slope         1 − slope/slope_max
///   flood         1 − depth of water/(`water_resistance` · height of the stem)
///   water         1 + clamp(W_avail/W_req − 1, 0, 1)
///   ground        `soil` · share of the roots in soil + `sand` · share in sand
///
/// with D_kj the competition matrix and W of water_uptake.hpp. The radius grows up to
///
///   r_largest = min((z − bedrock)/h_r, g_competition g_light r_max)
///   r_largest ≤ (surface of the water − z)/h_s   for underwater plants
///
/// A plant wider than `overgrown` r_largest is damaged, and shrinks if its species can. The damages d are
/// 0 at the limit of the allowed range and at most 1: radius too large, requirement of water not met, too
/// dark or too bright, ground too wet, slope too steep, roots exposed, stem buried, water too deep or, for
/// underwater plants, absent. Any damage stops growth. A plant dies at health 0, or if it is not mature by
/// `maturity_time`; it leaves humus. Plants read their neighbours' state before the step, so that their
/// order does not matter.
///
/// Reads bedrock, soil, sand, water, moisture, canopy_height, illumination, illumination_canopy and the
/// plants; writes humus and the plants.

#include "kernels/plants/density.hpp"
#include "kernels/plants/water_uptake.hpp"
#include "kernels/plants/workspace.hpp"

namespace desert_sim::plants {

/// Growth factors and sum of the damages of a plant, and its largest allowed radius r_largest [m].
struct Response {
  float competition = 1, light = 1, slope = 1, water = 1, flood = 1, ground = 1;
  float damage = 0, largest_radius = 0;
  DESERT_HD float growth() const { return competition * light * slope * water * flood * ground; }
};

/// How far a value is beyond a limit, relative to a scale and clamped to 0 … 1.
DESERT_HD float excess(float beyond, float scale) {
  return clamp(beyond / maximum(scale, 1e-6f), 0.0f, 1.0f);
}

/// What a step leaves of the radius of a plant that shrinks, at least. No parameter: it keeps radii positive.
constexpr float least_left = 0.05f;

/// The factor ¼ has no parameter: `competition`, D, is a factor beside it.
struct Competition {
  Neighbourhood near;
  View plants;
  const float* matrix;
  int species_count;
  float quantum;

  DESERT_HD float operator()(int k) const {
    const float x = plants.x[k], y = plants.y[k], r = plants.radius[k];
    const Quanta z = plants.z[k];
    const float* row = matrix + plants.species[k] * species_count;
    float sum = 0.0f;
    near.visit_near(x, y, r, [&](int j, const Neighbour& other) {
      if (j == k) return;
      const float dx = near.lookup.difference_x(x, other.x), dy = near.lookup.difference_y(y, other.y);
      const float dz = static_cast<float>(z - other.z) * quantum, flat2 = dx * dx + dy * dy;
      const float overlap = minimum(sqrtf(flat2 + dz * dz) - (r + other.radius), 0.0f) / r;
      sum += 0.25f * row[plants.species[j]] * (overlap * overlap);
    });
    return clamp(1.0f - sum, 0.0f, 1.0f);
  }
};

/// Illumination at the top of a plant, interpolated between that of the ground and that of the canopy.
DESERT_HD float light_at(float ground, float canopy, float canopy_height, float top_above_ground) {
  const float t = canopy_height > 1e-6f ? clamp(top_above_ground / canopy_height, 0.0f, 1.0f) : 0.0f;
  return lerp(ground, canopy, t);
}
DESERT_HD float light_factor(const SpeciesTraits& s, float light) {
  const float middle = 0.5f * (s.light_lowest + s.light_highest);
  const float half = maximum(0.5f * (s.light_highest - s.light_lowest), 1e-6f);
  return clamp(1.0f - fabsf(light - middle) / half, 0.0f, 1.0f);
}

struct Grow {
  WaterUptake water_uptake;
  Competition competition;
  View plants, next_state;
  const SpeciesTraits* species;
  const long long* water_requests;
  const float *canopy_height, *illumination, *illumination_canopy;
  float time_step, litter, overgrown;
  Die height_die;
  Quanta *granted_water, *humus;
  int* deaths;

  DESERT_HD const Site& site() const { return water_uptake.site; }

  /// Growth factors and damages by the plant's environment, except water uptake and competition.
  DESERT_HD void add_site_response(const SpeciesTraits& s, int n, int cell, Response& r) const {
    const Site& here = site();
    const float radius = plants.radius[n], stem = radius * s.stem, root = radius * s.root;
    const float above_ground = static_cast<float>(plants.z[n] - here.surface(cell)) * here.quantum;
    const float light =
        light_at(illumination[cell], illumination_canopy[cell], canopy_height[cell], above_ground + stem);
    r.light = light_factor(s, light);
    r.damage += excess(maximum(s.light_lowest - light, light - s.light_highest),
                       0.5f * (s.light_highest - s.light_lowest));
    const float slope = here.slope(cell);
    r.slope = clamp(1.0f - slope / s.slope, 0.0f, 1.0f);
    r.damage += excess(slope - s.slope, s.slope);
    r.damage += excess(here.relative_moisture(cell) - s.moisture_highest, 1.0f - s.moisture_highest);
    const Ground g =
        here.ground(cell, plants.z[n], stem * here.quanta_per_metre, root * here.quanta_per_metre);
    r.ground = ground_quality(s, g);
    r.damage += excess(s.root_cover - g.root_cover, s.root_cover);
    r.damage += excess(g.stem_cover - s.stem_cover, 1.0f - s.stem_cover);
    r.largest_radius = static_cast<float>(plants.z[n] - here.bedrock[cell]) * here.quantum / s.root;
    const float depth = here.water_depth(cell);
    if (lives_under_water(s)) {
      r.damage += depth > wet_depth ? 0.0f : 1.0f;
      r.largest_radius = minimum(r.largest_radius, (depth - above_ground) / s.stem);
    } else if (depth > wet_depth) {
      const float allowed = s.water_resistance * stem;
      r.flood = clamp(1.0f - depth / maximum(allowed, wet_depth), 0.0f, 1.0f);
      r.damage += excess(depth - allowed, stem);
    }
  }

  /// Water uptake and its effects; returns the water stored afterwards.
  DESERT_HD float take_up_water(const SpeciesTraits& s, int n, int cell, Response& r) const {
    const float stored = plants.water[n];
    const WaterDemand t = water_uptake.water_demand(s, n, plants.radius[n], stored, cell);
    granted_water[n] = water_uptake.granted(t.request, water_requests[cell], cell);
    const float share =
        t.request > 0 ? static_cast<float>(granted_water[n]) / static_cast<float>(t.request) : 1.0f;
    const float left = stored + t.wanted_water * share - t.required_water;
    r.damage += t.required_water > 0.0f && left < 0.0f ? excess(-left, t.required_water) : 0.0f;
    r.water = t.required_water > 0.0f
                  ? 1.0f + clamp(t.available_water * share / t.required_water - 1.0f, 0.0f, 1.0f)
                  : 2.0f;
    return clamp(left, 0.0f, t.storage_capacity);
  }

  /// Returns the new radius, and adds the damage of a radius that is too large.
  DESERT_HD float new_radius(const SpeciesTraits& s, float radius, Response& r) const {
    r.largest_radius = minimum(r.largest_radius, r.competition * r.light * s.max_radius);
    const bool too_wide = radius > overgrown * r.largest_radius;
    if (too_wide)
      r.damage += excess(radius - overgrown * r.largest_radius, overgrown * maximum(r.largest_radius, 0.0f));
    if (too_wide)
      return maximum(radius - time_step * s.shrink, maximum(r.largest_radius, least_left * radius));
    if (r.damage > 0.0f || radius >= r.largest_radius) return radius;
    return minimum(radius + time_step * s.growth * r.growth(), r.largest_radius);
  }

  DESERT_HD Quanta follow_ground(const SpeciesTraits& s, int n, Quanta z, int cell) const {
    const Quanta max_shift =
        height_die.whole_at_most(s.position_adjust * time_step * site().quanta_per_metre, load_limit, n);
    const Quanta distance = site().surface(cell) - z;
    return z + (distance > max_shift ? max_shift : (distance < -max_shift ? -max_shift : distance));
  }

  DESERT_HD void operator()(int n) const {
    const SpeciesTraits& s = species[plants.species[n]];
    const int cell = site().cell(plants.x[n], plants.y[n]);
    const float radius = plants.radius[n], age = plants.age[n];
    Response r;
    r.competition = competition(n);
    add_site_response(s, n, cell, r);
    const float stored = take_up_water(s, n, cell, r);
    const float grown = new_radius(s, radius, r);
    const float gain = r.damage > 0.0f || radius >= r.largest_radius ? 0.0f : s.growth * r.growth();
    float health = minimum(plants.health[n] + time_step * (gain - s.damage * r.damage), 1.0f);
    const bool due = age < s.maturity_time && age + time_step >= s.maturity_time;
    if (due && !is_mature(s, grown)) health = 0.0f;
    next_state.x[n] = plants.x[n];
    next_state.y[n] = plants.y[n];
    next_state.z[n] = follow_ground(s, n, plants.z[n], cell);
    next_state.radius[n] = grown;
    next_state.health[n] = health;
    next_state.water[n] = stored;
    next_state.age[n] = age + time_step;
    next_state.species[n] = plants.species[n];
    if (health > 0.0f) return;
    atomic_add(deaths, 1);
    atomic_add(&humus[cell], to_quanta_at_most(litter * s.humus, site().quanta_per_metre, load_limit >> 10));
  }
};

}  // namespace desert_sim::plants
