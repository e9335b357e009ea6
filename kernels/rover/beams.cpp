/// The law of beams.hpp; compiled once for each backend.
#include "kernels/rover/beams.hpp"

#include "kernels/backend/loops.hpp"
#include "kernels/field/draws.hpp"
#include "kernels/field/random.hpp"

namespace desert_sim::beams {

namespace {

template <class Surface>
struct Beam {
  Scan scan;
  Surface surface;
  int columns;
  const Vec3* directions;
  float *distances, *intensities;

  DESERT_HD RandomWords words(Purpose purpose, int n) const {
    return random_words(scan.seed, purpose, static_cast<std::uint32_t>(n),
                        static_cast<std::uint32_t>(scan.number),
                        static_cast<std::uint32_t>(scan.number >> 32));
  }
  DESERT_HD ray_march::Ray ray(const Vec3& d) const {
    const auto along = [&](const float(&row)[3]) { return row[0] * d.x + (row[1] * d.y + row[2] * d.z); };
    ray_march::Ray r = scan.origin;
    r.du = ray_march::not_zero(along(scan.turn[0]) / scan.cell_size);
    r.dv = ray_march::not_zero(along(scan.turn[1]) / scan.cell_size);
    r.dz = along(scan.turn[2]);
    r.per_du = 1.0f / r.du;
    r.per_dv = 1.0f / r.dv;
    r.metres = sqrtf(d.x * d.x + (d.y * d.y + d.z * d.z));
    return r;
  }
  /// |cos| of the angle between the ray and the normal (−∂h/∂x, −∂h/∂y, 1).
  DESERT_HD float incidence(const ray_march::Ray& r, const ray_march::Hit& hit) const {
    const float gx = hit.slope_u / scan.cell_size, gy = hit.slope_v / scan.cell_size;
    const float along_normal = r.dz - (hit.slope_u * r.du + hit.slope_v * r.dv);
    return minimum(fabsf(along_normal) / (r.metres * sqrtf(1.0f + (gx * gx + gy * gy))), 1.0f);
  }

  struct Return {
    float distance, intensity;
  };
  DESERT_HD Return first_return(int n) const {
    const ray_march::Ray r = ray(directions[n]);
    float plants_depth = 0.0f, dust_end = ray_march::never;
    bool dust_returns = false;
    if (scan.field.canopy || scan.field.dust) {
      const RandomWords draws = words(Purpose::beam_path, n);
      plants_depth = exponential_draw(draws.word[0]);
      dust_returns = positive_unit(draws.word[2]) <= scan.media.dust_returns;
      if (scan.field.dust)
        dust_end = ray_march::end_in_dust(scan.field, r, scan.farthest, scan.media.dust,
                                          exponential_draw(draws.word[1]));
    }
    const ray_march::Hit hit = ray_march::first_hit(scan.field, surface, r, minimum(scan.farthest, dust_end),
                                                    scan.media.canopy_extinction, plants_depth);
    if (hit.target == ray_march::Target::ground) return {hit.t, scan.reflectivity.ground * incidence(r, hit)};
    if (hit.target == ray_march::Target::plants) return {hit.t, scan.reflectivity.plants};
    return {dust_returns ? dust_end : ray_march::never, scan.reflectivity.dust};
  }
  DESERT_HD float measured(float distance, int n) const {
    const Noise& noise = scan.noise;
    if (!(distance >= scan.nearest && distance <= scan.farthest)) return NAN;
    const float deviation = noise.constant + (noise.per_metre + noise.per_square_metre * distance) * distance;
    if (!(deviation > 0.0f) && !(noise.dropout > 0.0f)) return distance;
    const RandomWords draws = words(Purpose::range_noise, n);
    const float noisy = distance + deviation * normal_draw(draws.word[0], draws.word[1]);
    const bool returns =
        positive_unit(draws.word[2]) > noise.dropout && noisy >= scan.nearest && noisy <= scan.farthest;
    return returns ? noisy : NAN;
  }
  DESERT_HD void operator()(int column, int row) const {
    const int n = row * columns + column;
    const Return found = first_return(n);
    const float distance = measured(found.distance, n);
    distances[n] = distance;
    intensities[n] = distance == distance ? found.intensity : 0.0f;
  }
};

}  // namespace

template <class E, class Surface>
void cast(E& exec, const Scan& scan, const Surface& surface, int columns, int rows, const Vec3* directions,
          float* distances, float* intensities) {
  for_each_cell(exec, Grid{columns, rows, 1.0f, false, false},
                Beam<Surface>{scan, surface, columns, directions, distances, intensities});
}

template void cast(Backend&, const Scan&, const ray_march::PlainGround&, int, int, const Vec3*, float*,
                   float*);
template void cast(Backend&, const Scan&, const ray_march::RippledGround&, int, int, const Vec3*, float*,
                   float*);

}  // namespace desert_sim::beams
