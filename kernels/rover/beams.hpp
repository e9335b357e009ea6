#pragma once
/// Beams of a range sensor: what a lidar or a depth camera measures of a height field (height_field.hpp).
/// ray_march.hpp and airborne_dust.hpp say where a beam ends.
///
///   distance    t + σ(t) N,  σ(t) = `noise` + `noise_per_metre` t + `noise_per_square_metre` t²
///   intensity   ground: ρ |cos(angle between beam and normal)|; plants and airborne sand: ρ
///
/// with a normal draw N and the reflectivity ρ of what was hit. A beam has no return (NaN, intensity 0) if it
/// hits nothing up to `farthest`, if what it hits is nearer than `nearest`, if noise puts it beyond either,
/// if it drops out, or if it ends in airborne sand and is lost there. Beams that end in airborne sand return
/// from there with the probability `dust_returns`.
///
/// All draws depend on the seed, the number of the scan and the number of the beam only. All arithmetic is
/// that of math.hpp, so a scan has the same bits on the CPU, with any number of threads, and on the GPU.

#include <cstdint>

#include "kernels/rover/airborne_dust.hpp"
#include "kernels/rover/height_field.hpp"
#include "kernels/rover/ray_march.hpp"

namespace desert_sim::beams {

struct Vec3 {
  float x, y, z;
};

struct Noise {
  float constant = 0, per_metre = 0, per_square_metre = 0;
  float dropout = 0;  ///< probability that a beam has no return
};

struct Media {
  float canopy_extinction = 0;
  ray_march::Dust dust{};
  float dust_returns = 0;
};

struct Reflectivity {
  float ground = 1, plants = 1, dust = 1;
};

/// What all beams of a scan have in common.
struct Scan {
  height_field::View field;
  ray_march::Ray origin;  ///< its direction is not used
  float cell_size;        ///< [m]
  float turn[3][3];       ///< from the sensor's frame to the terrain's
  float nearest, farthest;
  Noise noise;
  Media media;
  Reflectivity reflectivity;
  std::uint64_t seed, number;
};

/// Casts rows × columns beams, row-major. `directions`, in the sensor's frame, are of length 1 where
/// distances are to be along the beam; a distance is otherwise a multiple of the direction's length.
/// `surface`: what the ground between the centres of cells is, ray_march::PlainGround or RippledGround.
template <class E, class Surface>
void cast(E& exec, const Scan& scan, const Surface& surface, int columns, int rows, const Vec3* directions,
          float* distances, float* intensities);

}  // namespace desert_sim::beams
