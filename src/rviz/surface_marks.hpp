#pragma once
/// What a tool draws on the terrain: lines, and a text that has the same size at any distance. Both are
/// seen through the ground.

#include <memory>
#include <string>
#include <vector>

#include "src/render/draped_line.hpp"
#include "src/rviz/mesh_object.hpp"
#include "src/rviz/terrain_picker.hpp"

namespace Ogre {
class Camera;
class SceneManager;
}  // namespace Ogre
namespace rviz {
class MovableText;
}

namespace desert_sim {

class SurfaceMarks {
 public:
  /// `scene` must outlive it.
  explicit SurfaceMarks(Ogre::SceneManager& scene);
  ~SurfaceMarks();
  SurfaceMarks(const SurfaceMarks&) = delete;
  SurfaceMarks& operator=(const SurfaceMarks&) = delete;

  struct Line {
    std::vector<render::Point> points;  ///< as of the picker's field
    render::PackedColour colour;
  };
  /// Draws these lines and no others.
  void show(const TerrainPicker& terrain, const std::vector<Line>& lines);
  /// Shows a text over a point, with long lines broken; an empty text shows none.
  void show_text(const TerrainPicker& terrain, const std::string& text, const render::Point& at,
                 const Ogre::Viewport& viewport);
  void hide();

 private:
  Ogre::SceneManager& scene_;
  Ogre::SceneNode *const node_, *const text_node_;
  std::unique_ptr<MeshObject> lines_;
  std::unique_ptr<rviz::MovableText> text_, shadow_;
};

}  // namespace desert_sim
