#pragma once
/// Small scenarios for random commands and requests: one of sand and wind, one with all the rest.

namespace desert_sim::test {

inline constexpr const char* small_desert =
    "grid: {width: 16, height: 12}\n"
    "terrain: [noise: {layer: bedrock, low: 0, high: 2, scale: 6}, noise: {layer: sand, low: 0, high: 2}]\n"
    "wind: {features: [{x: 5, y: 5, radius: 3, id: 3}]}\n";
inline constexpr const char* small_oasis =
    "grid: {width: 14, height: 11, boundary: open}\n"
    "terrain: [uniform: {layer: soil, value: 2}, noise: {layer: sand, low: 0, high: 1},\n"
    "          uniform: {layer: moisture, value: 0.1}]\n"
    "rain: {rate: 1.0e-5}\n"
    "vegetation: {enabled: true}\n"
    "species: [{preset: bush, spawn: 100, moisture_lowest: 0, light_highest: 2}, {preset: tree}]\n";

}  // namespace desert_sim::test
