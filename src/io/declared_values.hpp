#pragma once
/// What a raster file says about the numbers of a band: scale, offset and unit.

#include <optional>
#include <string>
#include <vector>

namespace desert_sim {

/// value [m] = raw · scale + offset, as the file declares it.
struct DeclaredValues {
  double scale = 1, offset = 0;
};

/// Metres in a unit of length by the names that files give it ("m", "cm", "km", "ft", "US survey foot", …),
/// in upper or lower case; nothing for other units.
std::optional<double> metres_of_unit(const std::string& unit);

/// The declared conversion of a band to metres, from its declared scale, offset and unit. Adds a warning for
/// a unit that is no known length. A step's `given_scale` that is the declared one (to 0.1 %) is what
/// scenarios gave before these were read: it is said, and the file's is left out, so that it does not count
/// twice.
DeclaredValues declared_values(const std::string& path, double scale, double offset, const std::string& unit,
                               double given_scale, std::vector<std::string>& warnings);

}  // namespace desert_sim
