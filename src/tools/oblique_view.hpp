#pragma once
/// An oblique, lit picture of a terrain, drawn without a screen or a graphics card, in the colours of the
/// display in rviz.

#include <string>
#include <vector>

#include "src/core/parameter_table.hpp"
#include "src/render/rasteriser.hpp"
#include "src/render/terrain_look.hpp"
#include "src/simulation/simulation.hpp"

namespace desert_sim {

/// Where the camera stands, and what it shows. Given as --view KEY=VALUE.
constexpr const char* shading_names[] = {"sun", "illumination", "both"};

struct ViewParameters {
  int width = 1280;
  int height = 720;
  double azimuth_deg = -60;
  double elevation_deg = 32;
  double zoom = 1;
  double exaggeration = 1;
  double contour_interval = 0;
  std::string overlay;
  double overlay_low = 0;
  double overlay_high = 0;
  std::string second_overlay;
  double second_low = 0;
  double second_high = 0;
  double divide = 0;
  render::Shading shading = render::Shading::sun;
  bool water = true;
  bool plants = true;
  int fps = 25;
};
constexpr auto parameter_table(const ViewParameters*) {
  using P = ViewParameters;
  return std::make_tuple(
      parameter("width", &P::width, 16, 7680, "px", "Width of the picture; even for a film."),
      parameter("height", &P::height, 16, 4320, "px", "Height of the picture; even for a film."),
      parameter("azimuth_deg", &P::azimuth_deg, -360, 360, "deg",
                "Where the camera stands, counter-clockwise from +x (east); -90 is in the south."),
      parameter("elevation_deg", &P::elevation_deg, 1, 90, "deg", "How high it stands above the horizon."),
      parameter("zoom", &P::zoom, 0.1, 50, "1", "1 shows the whole terrain, 2 its middle twice as large."),
      parameter("exaggeration", &P::exaggeration, 0, 100, "1",
                "Factor of all heights; 0: one that makes relief visible, 1 to 20."),
      parameter("contour_interval", &P::contour_interval, 0, 1e4, "m",
                "Between contour lines; 0 draws none."),
      parameter("overlay", &P::overlay, "Layer shown as colours on the ground; empty shows the materials."),
      parameter("overlay_low", &P::overlay_low, -1e6, 1e6, "layer's", "Value with the first colour."),
      parameter("overlay_high", &P::overlay_high, -1e6, 1e6, "layer's",
                "Value with the last colour; equal to overlay_low, both are the layer's usual range."),
      parameter("second_overlay", &P::second_overlay, "Another layer, on the first one or beside it."),
      parameter("second_low", &P::second_low, -1e6, 1e6, "layer's", "As overlay_low."),
      parameter("second_high", &P::second_high, -1e6, 1e6, "layer's", "As overlay_high."),
      parameter("divide", &P::divide, 0, 1, "1",
                "Share of the width that the first overlay takes, in the west; 0: both lie on each other."),
      parameter("shading", &P::shading, shading_names,
                "What brightens the ground: the sun, the layer illumination, or their product."),
      parameter("water", &P::water, "Whether water is drawn."),
      parameter("plants", &P::plants, "Whether plants are drawn one by one."),
      parameter("fps", &P::fps, 1, 120, "1/s", "Pictures in a second of a film."));
}

/// The parameters with these settings, each "KEY=VALUE". Throws ConfigError that names all that are wrong,
/// also an unknown layer.
ViewParameters view_parameters(const std::vector<std::string>& settings);
/// Their table as text, for --help.
std::string describe_view();

class ObliqueView {
 public:
  explicit ObliqueView(const ViewParameters& parameters);
  /// The simulation's present state in the light of the sun, with shadows, before the sky. The camera and the
  /// exaggeration stay as they were for the first one.
  render::Picture draw(Simulation& simulation);

 private:
  void set_up(const Snapshot& snapshot, double lowest, double highest);

  const ViewParameters parameters_;
  double exaggeration_ = 0;  ///< 0: not chosen yet
  render::Box bounds_;       ///< of the first terrain, with exaggerated heights, x and y from its corner [m]
  render::Rasteriser rasteriser_;
  std::vector<render::PackedColour> sky_;  ///< for each sample of the picture
};

}  // namespace desert_sim
