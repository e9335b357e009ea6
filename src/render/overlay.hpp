#pragma once
/// A layer shown as colours on the ground: colour maps, and what a legend says.

#include <string>
#include <vector>

#include "src/render/colour.hpp"

namespace desert_sim::render {

enum class ColourMap {
  sequential,  ///< dark blue over green to yellow
  diverging,   ///< blue, white in the middle, red
  signal       ///< green, yellow, red
};

/// The colour of a share 0…1 of the range; those beyond count as the ends.
Colour colour_of(ColourMap map, float share);

struct Overlay {
  std::string layer;        ///< name of the layer; empty: no overlay
  float low = 0, high = 1;  ///< values with the first and the last colour; low may exceed high
  ColourMap map = ColourMap::sequential;
  float opacity = 0.7f;  ///< 0…1

  bool active() const { return !layer.empty(); }
  /// 0…1 within the range, clamped; 0.5 if the range is empty.
  float share(float value) const;
  /// The ground's colour under the overlay. Where the value is unknown (NaN), the ground shows.
  Colour on(const Colour& ground, float value) const;
};

/// What a layer is shown with unless the user chooses otherwise.
struct LayerStyle {
  std::string layer, unit;
  float low, high;
  ColourMap map;
};

/// The style of a layer; sequential from 0 to 1 for an unknown one.
LayerStyle layer_style(const std::string& layer);
/// The layers with a style, in the order in which a user is offered them.
const std::vector<LayerStyle>& layer_styles();

/// The smallest and the largest known value; 0 and 1 if none is known.
struct ValueRange {
  float low = 0, high = 1;
};
ValueRange range_of(const std::vector<float>& values);

/// A number for a legend: three significant digits, without trailing zeros.
std::string legend_number(double value);

/// The names of layers that are computed here from the elevation: its slope [deg], and its change since a
/// moment [m].
constexpr const char* slope_layer = "slope";
constexpr const char* change_layer = "change";
/// The layer of the simulation that can shade the ground.
constexpr const char* illumination_layer = "illumination";

}  // namespace desert_sim::render
