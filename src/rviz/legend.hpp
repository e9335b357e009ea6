#pragma once
/// Legends in the lower left corner of rviz's view.

#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "src/render/cost_colours.hpp"
#include "src/render/overlay.hpp"
#include "src/rviz/corner_picture.hpp"

namespace desert_sim {

/// The legend of a display that shows colours on the ground.
class Legend {
 public:
  /// Shows the overlay's colours from low to high, and says its name and unit.
  void show(const std::string& title, const render::Overlay& overlay);
  /// Shows the colours of costs.
  void show(const std::string& title, render::CostPalette palette);
  void hide() { picture_.hide(); }

 private:
  bool is_shown(const std::string& text);

  CornerPicture picture_{CornerPicture::Corner::left};
  std::string text_;  ///< what the picture says now
};

/// The legend of lines on the ground: one for all displays, in the order of their names.
class LineLegend {
 public:
  /// The one that all displays share, as long as one of them holds it.
  static std::shared_ptr<LineLegend> shared();

  /// `owner`: whose line it is; it replaces what it has said before.
  void show(const void* owner, const std::string& name, const render::Colour& colour);
  void hide(const void* owner);

 private:
  struct Line {
    std::string name;
    render::PackedColour colour;
    bool operator<(const Line& other) const {
      return std::tie(name, colour) < std::tie(other.name, other.colour);
    }
    bool operator==(const Line& other) const { return name == other.name && colour == other.colour; }
  };
  void draw();

  CornerPicture picture_{CornerPicture::Corner::left};
  std::map<const void*, Line> lines_;
};

}  // namespace desert_sim
