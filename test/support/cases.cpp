#include "test/support/cases.hpp"

#include "kernels/avalanching/avalanching_parameters.hpp"

namespace desert_sim::test {

std::string grid_yaml(int width, int height, const std::string& boundary) {
  return "grid: {width: " + std::to_string(width) + ", height: " + std::to_string(height) +
         ", cell_size: 1, boundary: " + boundary + "}\n";
}

std::vector<Case> process_cases(bool transforms) {
  const std::string fft =
      transforms ? "warping: true, projection: true" : "warping: false, projection: false";
  const std::string wind = "wind: {speed: 6, direction_deg: 27, " + fft + "}\n";
  const std::string dunes =
      "  - noise: {layer: bedrock, low: 0, high: 6, scale: 16}\n"
      "  - noise: {layer: sand, low: 0, high: 5, scale: 12, threshold: 0.3, seed: 2}\n";
  const std::string terrain = "terrain:\n" + dunes;
  const std::string worn = "abrasion: {rate: 0.02, cover: 0.5}\n";
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, const std::string& yaml) { cases.push_back({name, yaml}); };

  for (const char* method : {"off", "adaptive_repose", "smoothing", "steepest"})
    add(std::string("reptation ") + method, terrain + wind + "reptation: {method: " + method +
                                                ", strength: 0.4}\navalanching: {quality: fast}\n");
  for (const char* scheme : avalanche_schemes)
    for (const char* quality : {"fast", "good", "converged"})
      add(std::string("avalanching ") + scheme + " " + quality,
          terrain + wind + "avalanching: {scheme: " + scheme + ", quality: " + quality +
              ", sweeps: 12, max_iterations: 100, transfer: 1}\n");
  add("avalanching off", terrain + wind + "avalanching: {enabled: false}\n");
  add("soil, abrasion", terrain +
                            "  - noise: {layer: soil, low: 0, high: 3, scale: 8, threshold: 0.5, seed: 3}\n"
                            "  - noise: {layer: erosion_resistance, low: 0, high: 1, scale: 8, seed: 4}\n" +
                            wind + worn);
  add("abrasion to rock",
      terrain +
          "  - column: {layer: bedrock, relative: true, x: 0.5, y: 0.5, size_x: 6, size_y: 6, height: 15}\n" +
          wind + worn + "avalanching: {bedrock_to_sand: false}\n");
  add("bedrock breaks",
      terrain +
          "  - column: {layer: bedrock, relative: true, x: 0.3, y: 0.5, size_x: 6, size_y: 9, height: 25}\n" +
          wind + worn);
  add("vegetation",
      terrain + "  - noise: {layer: vegetation, low: 0, high: 1, scale: 10, threshold: 0.4, seed: 5}\n" +
          wind);
  add("wet ground",
      terrain +
          "  - noise: {layer: moisture, low: 0, high: 0.35, scale: 10, threshold: 0.5, seed: 6}\n"
          "  - noise: {layer: water, low: 0, high: 1, scale: 10, threshold: 0.7, seed: 7}\n" +
          wind);
  const std::string obstacles =
      "  - obstacle: {shape: cylinder, relative: true, x: 0.5, y: 0.5, size_x: 9, size_y: 9, height: 8}\n"
      "  - obstacle: {shape: box, relative: true, x: 0.1, y: 0.9, size_x: 7, size_y: 5, angle_deg: 30, "
      "height: 3}\n";
  add("obstacles", terrain + obstacles + wind);
  add("obstacles, smoothing, sweeps",
      terrain + obstacles + wind +
          "reptation: {method: smoothing, strength: 1}\navalanching: {scheme: sweeps, sweeps: 8}\n");
  add("echo dunes", terrain +
                        "  - column: {layer: bedrock, relative: true, x: 0.7, y: 0.5, size_x: 5, size_y: "
                        "100, height: 12}\n" +
                        wind + "echo_dunes: {enabled: true}\nwind_shadow: {curved: true}\n");
  add("influx", terrain + wind + "saltation: {influx: 0.5, lift: 0.4}\n");
  add("long hops", terrain + "wind: {speed: 40, direction_deg: 200, " + fft + "}\nrun: {time_step: 2}\n");
  add("features", terrain + "wind: {speed: 4, direction_deg: -60, " + fft +
                      ", features: [{kind: vortex, x: 10, y: 12, radius: 6, speed: 5}, {kind: jet, x: 20, y: "
                      "5, radius: 4, length: 15, "
                      "direction_deg: 40, speed: 6}, {kind: turbulence, x: 15, y: 15, radius: 14, scale: 5, "
                      "life_time: 4, speed: 4}]}\n");
  add("wind turns", terrain +
                        "wind: {regime: timeline, segments: [{direction_deg: 0, speed: 6, duration: 4, ramp: "
                        "2}, {direction_deg: "
                        "130, speed: 8, duration: 3, ramp: 1}], " +
                        fft + "}\n");
  const std::string real = std::string("wind: {speed: 11, direction_deg: 127, ") + fft +
                           "}\nrun: {time_step: 900}\n"
                           "sand: {model: continuum}\nsaltation: {influx: 1.0e-5, flux: true}\n" +
                           (transforms ? "" : "shear_stress: {in_phase: 0, in_quadrature: 0}\n");
  add("continuum", terrain + real + "looseness: {enabled: true}\n");
  add("continuum over all",
      terrain + obstacles +
          "  - noise: {layer: soil, low: 0, high: 3, scale: 8, threshold: 0.5, seed: 3}\n"
          "  - noise: {layer: vegetation, low: 0, high: 1, scale: 10, threshold: 0.4, seed: 5}\n"
          "  - noise: {layer: moisture, low: 0, high: 0.05, scale: 10, threshold: 0.5, seed: 6}\n"
          "  - noise: {layer: water, low: 0, high: 1, scale: 10, threshold: 0.7, seed: 7}\n" +
          real +
          "abrasion: {rate: 1.0e-4, cover: 0.5}\necho_dunes: {enabled: true}\n"
          "reptation: {method: smoothing, strength: 1.0e-4}\n");
  add("desertscape_2019", terrain + wind + "sand: {model: desertscape_2019}\n");
  add("desertscape_2019 over all",
      terrain + obstacles +
          "  - noise: {layer: soil, low: 0, high: 3, scale: 8, threshold: 0.5, seed: 3}\n"
          "  - noise: {layer: vegetation, low: 0, high: 1, scale: 10, threshold: 0.4, seed: 5}\n"
          "  - noise: {layer: moisture, low: 0, high: 0.05, scale: 10, threshold: 0.5, seed: 6}\n"
          "  - noise: {layer: water, low: 0, high: 1, scale: 10, threshold: 0.7, seed: 7}\n"
          "  - uniform: {layer: airborne_sand, value: 0.3}\n" +
          wind +
          "sand: {model: desertscape_2019}\nsaltation: {lift: 0.4, influx: 0.5, flux: true}\n"
          "abrasion: {rate: 0.01, cover: 0.5}\necho_dunes: {enabled: true}\n");
  const std::string blown = "wind: {speed: 5, direction_deg: 27}\n";
  add("werner", terrain + blown + "sand: {model: werner}\n");
  add("momiji over rock",
      terrain + obstacles + "  - noise: {layer: soil, low: 0, high: 3, scale: 8, threshold: 0.5, seed: 3}\n" +
          blown +
          "saltation: {influx: 0.5}\n"
          "sand: {model: momiji}\nslab_model: {polling: non_repeated, poll_time: 0.7}\n");
  add("bishop", terrain + blown + "sand: {model: bishop}\nslab_model: {hop_time: 0.6}\n");
  add("wang", terrain + obstacles +
                  "  - noise: {layer: vegetation, low: 0, high: 1, scale: 10, threshold: 0.5, seed: 5}\n" +
                  "wind: {speed: 30, direction_deg: 27}\nsaltation: {influx: 1.0e-5}\nsand: {model: wang}\n");
  add("werner, forced erosion", terrain + blown +
                                    "saltation: {influx: 0.5}\n"
                                    "sand: {model: werner}\nslab_model: {polling: non_repeated, poll_time: "
                                    "0.7, forced_erosion: true}\n");
  add("nield_baas",
      terrain +
          "  - noise: {layer: grass, low: 0, high: 1, scale: 8, seed: 3}\n"
          "  - noise: {layer: mesquite, low: -1, high: 1, scale: 6, seed: 4}\n"
          "  - noise: {layer: shrub, low: -0.5, high: 1, scale: 9, seed: 5}\n" +
          blown +
          "sand: {model: nield_baas}\nslab_model: {slab_height: 0.1}\nslab_plants: {growth_time: 3.5}\n");
  add("snow", terrain + blown +
                  "sand: {model: snow}\nslab_model: {poll_time: 43200}\nrun: {time_step: 43200}\n"
                  "slab_snow: {temperature: -8, settling_time: 86400}\n");
  const std::string wet =
      "rain: {rate: 2.0e-4, share_low: 0.3, share_high: 0.7, height: 8, scale: 12, frequency: 0.1}\n"
      "hydraulic_erosion: {enabled: true, capacity: 1}\nmoisture: {enabled: true}\n";
  const std::string springs =
      "springs: [{x: 9.5, y: 20.5, radius: 3, discharge: 3}, {x: 30, y: 5, radius: 0, "
      "discharge: 0.5}]";
  const std::string soil = "  - noise: {layer: soil, low: 0, high: 3, scale: 8, threshold: 0.3, seed: 3}\n";
  add("springs on bare rock", terrain + wind + "hydraulic_erosion: {enabled: true}\nwater: {" + springs +
                                  "}\nrun: {check_every: 1}\n");
  add("rivers", terrain + soil + wind + wet + "water: {drag: 0.02, " + springs + "}\n");
  add("sea, waves",
      terrain + soil + obstacles + wind + wet +
          "water: {enabled: true, sea: border, sea_level: 2.5, wave_strength: 0.05, wave_period: "
          "4, most_substeps: 6}\n");
  add("shallow water, rivers", terrain + soil + wind + wet +
                                   "water: {model: shallow_water, manning: 0.03, drag: 0.01, " + springs +
                                   "}\n");
  add("shallow water, sea, waves",
      terrain + soil + obstacles + wind + wet +
          "water: {enabled: true, model: shallow_water, sea: border, sea_level: 2.5, wave_strength: 0.05, "
          "wave_period: 4}\n");
  add("a flood dries",
      terrain + soil +
          "  - uniform: {layer: water, value: 2}\n"
          "  - noise: {layer: vegetation, low: 0, high: 1, scale: 10, threshold: 0.4, seed: 5}\n"
          "  - uniform: {layer: humus, value: 0.05}\n" +
          wind +
          "water: {enabled: true, evaporation: 0.3}\nmoisture: {enabled: true, diffusion: "
          "0.4, evaporation: 20}\nsoil: {enabled: true, drying: 0.1}\n");
  // Many seeds, so that within a few steps there are births, deaths, thirst, and all of a kind's places
  // taken.
  const std::string life =
      terrain +
      "  - noise: {layer: soil, low: 0.5, high: 4, scale: 8, seed: 3}\n"
      "  - noise: {layer: moisture, low: 0, high: 0.2, scale: 10, seed: 6}\n"
      "  - noise: {layer: water, low: 0, high: 4, scale: 10, threshold: 0.7, seed: 7}\n" +
      wind +
      "species: [{preset: bush, spawn: 200, light_highest: 2, moisture_lowest: 0, maturity_time: 4, "
      "separation: 10, "
      "growth: 0.5, slope: 9}, {preset: seaweed, spawn: 300, spawn_wind: 99, slope: 9}, "
      "{preset: tree, spawn: 50, growth: 3, moisture_lowest: 0, slope: 9}]\n"
      "competition: [[1, 0, 2], [0.5, 1, 1], [0.1, 1, 1]]\n";
  add("plants", life + "vegetation: {enabled: true, draw: 1}\nrun: {check_every: 2}\n");
  add("plants, more than there is room for",
      life + "vegetation: {enabled: true, max_plants: 40, light_deg: 30}\nrun: {time_step: 0.3}\n");
  add("looseness",
      terrain +
          "  - noise: {layer: soil, low: 0, high: 2, scale: 8, threshold: 0.5, seed: 3}\n"
          "  - noise: {layer: moisture, low: 0, high: 0.3, scale: 10, threshold: 0.6, seed: 6}\n" +
          wind + "looseness: {enabled: true}\n");
  add("everything",
      terrain +
          "  - noise: {layer: soil, low: 0, high: 2, scale: 8, threshold: 0.5, seed: 3}\n"
          "  - noise: {layer: vegetation, low: 0, high: 1, scale: 10, threshold: 0.6, seed: 5}\n"
          "  - noise: {layer: moisture, low: 0, high: 0.3, scale: 10, threshold: 0.6, seed: 6}\n" +
          obstacles + wind + worn + wet + "soil: {enabled: true}\nwater: {" + springs + "}\n" +
          "echo_dunes: {enabled: true}\nwind_shadow: {curved: true}\nreptation: {method: steepest}\n"
          "saltation: {influx: 0.2}\nrun: {check_every: 1}\n");
  return cases;
}

}  // namespace desert_sim::test
